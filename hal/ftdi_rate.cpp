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
  const auto off_by = [&](double eighths) { return std::abs(8.0 * clock / eighths - asked); };
  // Of the divisors on both sides the one with the nearer rate. Between 8 and 16 eighths there are 8, 12 and
  // 16 only.
  const bool coarse = wanted < 16.0;
  const double below = coarse ? 8.0 : std::min(std::floor(wanted), kMostEighths);
  double eighths = below;
  for (const double candidate : {coarse ? 12.0 : below, coarse ? 16.0 : std::min(below + 1.0, kMostEighths)})
    if (off_by(candidate) < off_by(eighths)) eighths = candidate;
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
