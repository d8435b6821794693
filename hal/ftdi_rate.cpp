#include "hal/ftdi_rate.hpp"

#include <algorithm>
#include <cmath>

#include "hal/ftdi_wire.hpp"

namespace forager::hal {

FtdiRate ftdi_rate(std::uint32_t asked, bool fast) {
  constexpr double kMostEighths = 16384.0 * 8 - 1;  // 14 bits of whole ones
  const bool fast_clock = fast && asked >= ftdi::kFastClockFrom;
  const double clock = fast_clock ? ftdi::kFastClock : ftdi::kClock;
  const double wanted = 8.0 * clock / asked;
  // Between 8 and 16 eighths there are 8, 12 and 16 only.
  double eighths = std::clamp(std::round(wanted), 8.0, kMostEighths);
  if (eighths < 16.0) {
    eighths = 8.0;
    for (const double candidate : {12.0, 16.0})
      if (std::abs(8.0 * clock / candidate - asked) < std::abs(8.0 * clock / eighths - asked))
        eighths = candidate;
  }
  const auto whole = static_cast<std::uint32_t>(eighths);
  std::uint32_t code = whole / 8;
  if (whole == 8)
    code = 0;
  else if (whole == 12)
    code = 1;
  else
    code |= static_cast<std::uint32_t>(ftdi::kEighths[whole % 8]) << ftdi::kEighthsShift;
  if (fast_clock) code |= ftdi::kFastClockBit;
  const double baud = 8.0 * clock / eighths;
  return {code, baud, (baud - asked) / asked};
}

}  // namespace forager::hal
