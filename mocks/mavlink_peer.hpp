#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

#include "mocks/mavlink_peer_wire.hpp"

namespace forager::mocks {

// Numbers at byte offsets of an untrimmed payload, little-endian as on the wire and on every board here.
static_assert(std::endian::native == std::endian::little);

class MavlinkPayload {
 public:
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }
  void f32(std::size_t offset, double value) { put(offset, static_cast<float>(value)); }
  void text(std::size_t offset, std::size_t room, std::string_view text) {
    std::memcpy(bytes_.data() + offset, text.data(), text.size() < room ? text.size() : room);
  }
  template <class T>
  [[nodiscard]] T get(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  [[nodiscard]] double f32(std::size_t offset) const { return static_cast<double>(get<float>(offset)); }
  [[nodiscard]] std::span<const std::byte> bytes(std::size_t count) const {
    return std::span(bytes_).first(count);
  }
  [[nodiscard]] std::span<std::byte> room() { return bytes_; }

 private:
  std::array<std::byte, 256> bytes_{};
};

struct MavlinkPeerFrame {
  std::uint32_t id = 0;
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  std::uint8_t sequence = 0;
  bool mavlink1 = false;
  std::size_t size = 0;    // payload bytes that came; the rest of the payload is zero
  MavlinkPayload payload;  // untrimmed
};

// CRC-16/MCRF4XX: reflected 0x1021, start 0xFFFF, no final xor; 0x6F91 for "123456789".
[[nodiscard]] std::uint16_t mavlink_peer_crc(std::span<const std::byte> bytes, std::uint16_t crc = 0xFFFF);

// Frames what one component says, with its sequence number.
class MavlinkPeerPacker {
 public:
  MavlinkPeerPacker(std::uint8_t system, std::uint8_t component, bool mavlink1 = false)
      : system_(system), component_(component), mavlink1_(mavlink1) {}
  // The frame, valid until the next call. Empty if MAVLink 1 has no room for the message id.
  [[nodiscard]] std::span<const std::byte> pack(const peer::MessageKind& kind, const MavlinkPayload& payload);
  void set_next_sequence(std::uint8_t sequence) { sequence_ = sequence; }

 private:
  std::uint8_t system_;
  std::uint8_t component_;
  bool mavlink1_;
  std::uint8_t sequence_ = 0;
  std::array<std::byte, 280> frame_{};
};

// Finds frames in a byte stream that may start anywhere, be cut anywhere and hold noise. Versions 1 and 2;
// signatures are skipped unchecked, as an autopilot without a key does. Only messages of peer::kKnown pass.
class MavlinkPeerParser {
 public:
  // As many bytes as fit go in; take frames with next() and push the rest. Returns the count taken.
  [[nodiscard]] std::size_t push(std::span<const std::byte> bytes);
  // The next good frame, valid until the next call, or nullptr when more bytes are needed.
  [[nodiscard]] const MavlinkPeerFrame* next();
  // Start bytes that led to no good frame: noise, bad checksums and unknown messages.
  [[nodiscard]] std::uint64_t bad() const { return bad_; }

 private:
  enum class Step : std::uint8_t { frame, more, reject };
  Step take();
  bool decode(std::size_t header, std::size_t length, std::uint32_t id);

  std::array<std::byte, 1024> buffer_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t bad_ = 0;
  MavlinkPeerFrame frame_;
};

}  // namespace forager::mocks
