#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "flight/mavlink/description.hpp"
#include "flight/mavlink/frame.hpp"

namespace forager::flight::mavlink {

// Who sends on one link, and the number of its next frame there.
struct Sender {
  std::uint8_t sysid = 1;
  std::uint8_t compid = component::kOnboardComputer;
  std::uint8_t next_sequence = 0;
};

namespace detail {

static_assert(std::endian::native == std::endian::little,
              "fields are copied as they lie; the wire is little-endian");

template <class T>
void store(std::byte* at, const T& value) {
  std::memcpy(at, &value, sizeof(T));
}
template <class T>
void load(const std::byte* at, T& value) {
  std::memcpy(&value, at, sizeof(T));
}

// Header and CRC around a payload already in place; v2 drops trailing zero bytes but keeps one.
void seal_v2(FrameBuffer& buffer, std::uint32_t id, std::size_t full_length, std::uint8_t crc_extra,
             Sender& sender, std::uint8_t incompat_flags);
void seal_v1(FrameBuffer& buffer, std::uint32_t id, std::size_t base_length, std::uint8_t crc_extra,
             Sender& sender);

}  // namespace detail

// Writes the untrimmed payload, kLayout<M>.full_length bytes.
template <Message M>
void pack(const M& message, std::byte* payload) {
  for_each_field(message, [&](const FieldLayout& layout, const auto& value) {
    detail::store(payload + layout.offset, value);
  });
}

// A MAVLink 2 frame. With incompat_flags = kIncompatSigned the frame is only whole after Signing::sign().
// The returned bytes are those of `buffer`. Takes one sequence number of the sender.
template <Message M>
std::span<const std::byte> encode(const M& message, Sender& sender, FrameBuffer& buffer,
                                  std::uint8_t incompat_flags = 0) {
  constexpr auto& kShape = kLayout<M>;
  static_assert(kShape.full_length <= kMaxPayload);
  pack(message, buffer.data() + kHeaderV2);
  detail::seal_v2(buffer, M::kId, kShape.full_length, kShape.crc_extra, sender, incompat_flags);
  return buffer.bytes();
}

// A MAVLink 1 frame: the base fields only, never trimmed.
template <Message M>
requires(M::kId <= 0xFF) std::span<const std::byte> encode_v1(const M& message, Sender& sender,
                                                              FrameBuffer& buffer) {
  constexpr auto& kShape = kLayout<M>;
  pack(message, buffer.data() + kHeaderV1);  // extensions land behind the base fields and are overwritten
  detail::seal_v1(buffer, M::kId, kShape.base_length, kShape.crc_extra, sender);
  return buffer.bytes();
}

// The message in a frame whose id is M::kId. Bytes the sender trimmed are zero; bytes beyond those known here
// (newer extensions), and extensions in a v1 frame, are ignored.
template <Message M>
[[nodiscard]] M decode(const Frame& frame) {
  constexpr auto& kShape = kLayout<M>;
  const std::size_t known = frame.version == Version::v1 ? kShape.base_length : kShape.full_length;
  M message;
  const auto unpack = [&](const std::byte* payload) {
    for_each_field(message, [&](const FieldLayout& layout, auto& value) {
      detail::load(payload + layout.offset, value);
    });
  };
  if (frame.payload.size() >= kShape.full_length && frame.version == Version::v2) {
    unpack(frame.payload.data());
  } else {
    std::array<std::byte, kShape.full_length> padded{};
    std::copy_n(frame.payload.data(), std::min(known, frame.payload.size()), padded.data());
    unpack(padded.data());
  }
  return message;
}

}  // namespace forager::flight::mavlink
