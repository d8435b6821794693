#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace forager::mocks {

// CRC of a frame on a serial line (Modbus over serial line V1.02, section 2.5.1.2: polynomial 0xA001); over
// data and CRC together it is zero.
[[nodiscard]] std::uint16_t modbus_crc(std::span<const std::uint8_t> bytes);

// Low byte first.
void append_modbus_crc(std::vector<std::uint8_t>& frame);

}  // namespace forager::mocks
