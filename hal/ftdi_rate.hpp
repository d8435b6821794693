#pragma once

#include <cstdint>

namespace forager::hal {

// How an FTDI chip makes a rate (AN232B-05).
struct FtdiRate {
  std::uint32_t divisor = 0;  // 18 bits, as the request carries them
  double baud = 0.0;          // what comes out
  double error = 0.0;         // (comes out - asked) / asked
};

// The nearest rate to the one asked for; `fast`: a chip of the H generation. `asked` is positive.
[[nodiscard]] FtdiRate ftdi_rate(std::uint32_t asked, bool fast);

}  // namespace forager::hal
