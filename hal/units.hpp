#pragma once

#include <cmath>
#include <numbers>

namespace forager::hal {

inline constexpr double kPi = std::numbers::pi;

[[nodiscard]] constexpr double deg_to_rad(double deg) { return deg * (kPi / 180.0); }
[[nodiscard]] constexpr double rad_to_deg(double rad) { return rad * (180.0 / kPi); }

// Wraps an angle to (-pi, pi]. Idempotent; NaN and infinities give NaN.
[[nodiscard]] inline double wrap_pi(double angle_rad) {
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

// Shortest signed turn from one heading to another, in (-pi, pi].
[[nodiscard]] inline double angle_difference(double to_rad, double from_rad) {
  return wrap_pi(to_rad - from_rad);
}

}  // namespace forager::hal
