#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "flight/mavlink/mavlink_wire.hpp"

namespace forager::flight::mavlink {

enum class Version : std::uint8_t { v1, v2 };

// One frame as it came off a wire, its CRC good. The spans point into the parser's buffer and hold until it
// is fed again.
struct Frame {
  Version version = Version::v2;
  std::uint8_t incompat_flags = 0;  // v1: 0
  std::uint8_t compat_flags = 0;    // v1: 0
  std::uint8_t sequence = 0;
  std::uint8_t sysid = 0;
  std::uint8_t compid = 0;
  std::uint32_t id = 0;
  std::span<const std::byte> payload;  // as sent: shorter or longer than the message here knows
  std::span<const std::byte> bytes;    // STX to CRC, or to the end of the signature

  [[nodiscard]] bool is_signed() const { return (incompat_flags & kIncompatSigned) != 0; }
};

// Room for the largest frame; what encode() and Signing::sign() write into.
class FrameBuffer {
 public:
  [[nodiscard]] std::span<const std::byte> bytes() const { return {storage_.data(), size_}; }
  [[nodiscard]] std::byte* data() { return storage_.data(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  // Size may not exceed kMaxFrame; only encoders call it.
  void set_size(std::size_t size) { size_ = size; }

 private:
  std::array<std::byte, kMaxFrame>
      storage_;  // set up to size_ only: clearing 280 bytes costs more than a CRC
  std::size_t size_ = 0;
};

}  // namespace forager::flight::mavlink
