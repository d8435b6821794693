#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/error.hpp"

// Turn-then-drive geometry of a vehicle that is pushed forward and steered by braking one wheel (thesis
// sec. 6.5.3; the printed equations 6.5 to 6.10 are wrong, see docs/driving.md).
namespace forager::servo {

// A point in the body frame at the moment of planning, metres: x forward, y left, origin between the wheels.
struct Target {
  double x_m = 0.0;
  double y_m = 0.0;
  bool operator==(const Target&) const = default;
};

}  // namespace forager::servo
