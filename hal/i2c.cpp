#include "hal/i2c.hpp"

#include <fmt/format.h>

namespace forager::hal {

Result<> I2c::transfer(std::uint8_t address, std::span<const std::byte> bytes, std::span<std::byte> into) {
  constexpr std::uint8_t kFirst = 0x08;  // I2C-bus specification UM10204 table 4: 0000 xxx and 1111 xxx
  constexpr std::uint8_t kLast = 0x77;   // are reserved
  constexpr std::size_t kMost = 4096;  // one message of i2c-dev is at most 8192; no chip here needs that much
  const auto operation = [&] { return fmt::format("transfer with 0x{:02x}", address); };
  if (address < kFirst || address > kLast)
    return fail(ErrorCode::invalid_argument, std::string(name()), operation(),
                "a chip's address is from 0x08 to 0x77", "Give the 7-bit address, without the R/W bit");
  if ((bytes.empty() && into.empty()) || bytes.size() > kMost || into.size() > kMost)
    return fail(ErrorCode::invalid_argument, std::string(name()), operation(),
                fmt::format("{} bytes out and {} in: from 1 to {} can be transferred", bytes.size(),
                            into.size(), kMost));
  return do_transfer(address, bytes, into);
}

}  // namespace forager::hal
