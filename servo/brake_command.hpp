#pragma once

#include "hal/time.hpp"

namespace forager::servo {

// How hard each brake is to press: 0 is open, 1 is locked; values between press in part, where the actuator
// can. Default-constructed it locks both and has expired.
struct BrakeCommand {
  double left = 1.0;
  double right = 1.0;
  hal::Instant valid_until{hal::Duration::min()};  // ignored from then on: both brakes lock
};

[[nodiscard]] constexpr BrakeCommand both_locked(hal::Instant valid_until) { return {1.0, 1.0, valid_until}; }
[[nodiscard]] constexpr BrakeCommand both_open(hal::Instant valid_until) { return {0.0, 0.0, valid_until}; }
// Pivots about the left wheel: a turn to the left (counter-clockwise seen from above).
[[nodiscard]] constexpr BrakeCommand left_locked(hal::Instant valid_until) { return {1.0, 0.0, valid_until}; }
[[nodiscard]] constexpr BrakeCommand right_locked(hal::Instant valid_until) {
  return {0.0, 1.0, valid_until};
}

}  // namespace forager::servo
