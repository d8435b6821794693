#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace forager::reader {

// An Electronic Product Code as it stands in the tag: 2..62 bytes in steps of two (Gen2 protocol control
// word: 1..31 words). Value type, no heap; unused bytes are zero so that comparison is plain.
class Epc {
 public:
  static constexpr std::size_t kMaxBytes = 62;

  Epc() = default;

  // From hexadecimal digits of either case. Errors: invalid_argument (empty, odd number of bytes' digits,
  // longer than 62 bytes, not hexadecimal).
  [[nodiscard]] static hal::Result<Epc> from_hex(std::string_view hex);
  // From bytes, same limits.
  [[nodiscard]] static hal::Result<Epc> from_bytes(std::span<const std::uint8_t> bytes);

  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return {bytes_.data(), size_}; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  // Lower-case hexadecimal, as the AdvanReader streams it.
  [[nodiscard]] std::string hex() const;
  // 64-bit mix of all bytes (not cryptographic).
  [[nodiscard]] std::uint64_t hash() const;

  friend bool operator==(const Epc&, const Epc&) = default;
  friend auto operator<=>(const Epc&, const Epc&) = default;

 private:
  std::array<std::uint8_t, kMaxBytes> bytes_{};
  std::uint8_t size_ = 0;
};

}  // namespace forager::reader

template <>
struct std::hash<forager::reader::Epc> {
  std::size_t operator()(const forager::reader::Epc& epc) const noexcept {
    return static_cast<std::size_t>(epc.hash());
  }
};
