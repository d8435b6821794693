#include "flight/mavlink/crc.hpp"

namespace forager::flight::mavlink {

std::uint16_t crc_add(std::uint16_t crc, std::span<const std::byte> bytes) {
  const auto& tables = detail::kCrcTables;
  const std::byte* p = bytes.data();
  std::size_t left = bytes.size();
  const auto at = [&](std::size_t i) { return std::to_integer<std::size_t>(p[i]); };
  for (; left >= 8; left -= 8, p += 8)
    crc = static_cast<std::uint16_t>(tables[7][(crc & 0xFFU) ^ at(0)] ^ tables[6][(crc >> 8U) ^ at(1)] ^
                                     tables[5][at(2)] ^ tables[4][at(3)] ^ tables[3][at(4)] ^
                                     tables[2][at(5)] ^ tables[1][at(6)] ^ tables[0][at(7)]);
  for (; left > 0; --left, ++p) crc = crc_add(crc, std::to_integer<std::uint8_t>(*p));
  return crc;
}

}  // namespace forager::flight::mavlink
