// The MAVLink parser and codec: any bytes, cut anywhere, give the same frames; every byte is accounted for;
// and every frame accepted encodes again to the same payload, but for zeros trimmed and fields unknown here.
// The first input byte says how to cut; odd: the rest is also sent as the payload of a known message, as a
// fuzzer cannot guess a CRC.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/crc.hpp"
#include "flight/mavlink/parser.hpp"
#include "flight/mavlink/registry.hpp"

namespace {

using namespace forager::flight::mavlink;
using Bytes = std::vector<std::byte>;

void require(bool holds) {
  if (!holds) std::abort();
}

std::span<const std::byte> trimmed(std::span<const std::byte> payload) {
  while (payload.size() > 1 && payload.back() == std::byte{0}) payload = payload.first(payload.size() - 1);
  return payload;
}

template <Message M>
void check_again(const Frame& frame) {
  const M message = decode<M>(frame);
  Sender sender{frame.sysid, frame.compid, frame.sequence};
  FrameBuffer buffer;
  const auto again = encode(message, sender, buffer);
  const std::size_t known = frame.version == Version::v1 ? kLayout<M>.base_length : kLayout<M>.full_length;
  Bytes full(kLayout<M>.full_length);
  std::copy_n(frame.payload.begin(), std::min(known, frame.payload.size()), full.begin());
  const auto payload = again.subspan(kHeaderV2, again.size() - kHeaderV2 - kCrcSize);
  require(std::ranges::equal(payload, trimmed(full)));
  Parser parser;
  int heard = 0;
  parser.feed(again, [&](const Frame& f) {
    ++heard;
    require(f.id == frame.id && f.sequence == frame.sequence && f.sysid == frame.sysid);
  });
  require(heard == 1);
}

void check(const Frame& frame) {
  require(frame.bytes.size() <= kMaxFrame && find_message(frame.id) != nullptr);
  for_each_message([&](const auto& type) {
    using M = std::decay_t<decltype(type)>;
    if (frame.id == M::kId) check_again<M>(frame);
  });
}

// The frames as one string of bytes, fed `step` bytes at a time.
Bytes frames_of(std::span<const std::byte> bytes, std::size_t step) {
  Parser parser;
  Bytes all;
  const auto take = [&](const Frame& frame) {
    check(frame);
    all.insert(all.end(), frame.bytes.begin(), frame.bytes.end());
  };
  for (std::size_t at = 0; at < bytes.size(); at += step)
    parser.feed(bytes.subspan(at, std::min(step, bytes.size() - at)), take);
  parser.flush(take);
  const ParserStats& stats = parser.stats();
  require(stats.bytes == bytes.size() && !parser.has_partial_frame());
  require(all.size() + stats.skipped_bytes <= stats.bytes);
  if (stats.unknown == 0) require(all.size() + stats.skipped_bytes == stats.bytes);
  return all;
}

Bytes as_known_message(std::span<const std::byte> bytes) {
  const auto known = known_messages();
  const MessageInfo& info = known[std::to_integer<std::size_t>(bytes[0]) % known.size()];
  const auto payload = bytes.subspan(1, std::min<std::size_t>(bytes.size() - 1, kMaxPayload));
  Bytes frame{std::byte{kStxV2}, std::byte(payload.size()), {}, {}, {}, std::byte{1}, std::byte{1}};
  for (const unsigned shift : {0U, 8U, 16U}) frame.push_back(std::byte((info.id >> shift) & 0xFFU));
  frame.insert(frame.end(), payload.begin(), payload.end());
  const std::uint16_t crc =
      crc_add(crc_add(kCrcStart, std::span<const std::byte>(frame).subspan(1)), info.crc_extra);
  frame.push_back(std::byte(crc & 0xFFU));
  frame.push_back(std::byte(crc >> 8U));
  return frame;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::size_t step = 1 + data[0] / 2U;
  Bytes stream(reinterpret_cast<const std::byte*>(data) + 1, reinterpret_cast<const std::byte*>(data) + size);
  if (data[0] % 2 == 1) {
    const Bytes known = as_known_message(stream);
    stream.insert(stream.end(), known.begin(), known.end());
  }
  require(frames_of(stream, step) == frames_of(stream, stream.size()));
  return 0;
}
