#include "hal/time.hpp"

#include <cmath>
#include <limits>

namespace forager::hal {

Duration from_seconds(double seconds) {
  constexpr double kLimit = 9.2e18;  // just inside int64 nanoseconds
  const double ns = seconds * 1e9;
  if (std::isnan(ns)) return Duration::zero();
  if (ns >= kLimit) return Duration::max();
  if (ns <= -kLimit) return Duration::min();
  return Duration(std::llround(ns));
}

}  // namespace forager::hal
