#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace forager::flight::mavlink {

// CRC-16/MCRF4XX: polynomial 0x1021 reflected, start 0xFFFF, no final inversion (MAVLink serialization, the
// "X.25" of its texts). Check value of "123456789" is 0x6F91.
inline constexpr std::uint16_t kCrcStart = 0xFFFF;

namespace detail {

using CrcTable = std::array<std::uint16_t, 256>;

// tables[k][b] is the CRC of byte b followed by k zero bytes, so that eight bytes cost eight independent
// lookups instead of a chain of eight.
consteval std::array<CrcTable, 8> crc_tables() {
  std::array<CrcTable, 8> tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0x8408U : crc >> 1U;
    tables[0][byte] = static_cast<std::uint16_t>(crc);
  }
  for (std::size_t k = 1; k < tables.size(); ++k)
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint16_t shorter = tables[k - 1][byte];
      tables[k][byte] = static_cast<std::uint16_t>((shorter >> 8U) ^ tables[0][shorter & 0xFFU]);
    }
  return tables;
}

inline constexpr std::array<CrcTable, 8> kCrcTables = crc_tables();

}  // namespace detail

[[nodiscard]] constexpr std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {
  return static_cast<std::uint16_t>((crc >> 8U) ^ detail::kCrcTables[0][(crc ^ byte) & 0xFFU]);
}

[[nodiscard]] constexpr std::uint16_t crc_add(std::uint16_t crc, std::string_view text) {
  for (const char c : text) crc = crc_add(crc, static_cast<std::uint8_t>(c));
  return crc;
}

// The CRC of `bytes` continued from `crc`.
[[nodiscard]] std::uint16_t crc_add(std::uint16_t crc, std::span<const std::byte> bytes);

}  // namespace forager::flight::mavlink
