#pragma once

#include <cstdint>

#include "servo/turn_then_drive.hpp"

// Equations 6.5 to 6.10 of the thesis as printed, so that the closed form in servo/turn_then_drive can be
// held against them. No vehicle is driven by them.
namespace forager::boards {

enum class Reading : std::uint8_t {
  as_printed,
  mended,  // c = r^4 - r^2 y^2 in 6.7, the other coordinate by 6.5 with x of S'_i, 6.10 measured from S'_i:
           // what remains is the division by y and the choice of the point
};

struct PublishedTurn {
  bool left = true;
  double turn_rad = 0.0;  // 0 .. 2 pi about the held wheel; NaN: the equations have no real solution
  double drive_m = 0.0;
};

// The constants of 6.6 are those of r = 0.5 m. O, the origin of the equations, is the held wheel: S_i is
// (0, -r) beside the left one and the target (X, Y - r), mirrored for the right one. Where the text leaves a
// choice the kinder one is taken: the wheel at the target's side is held (the comparison 6.9 names the other
// one wherever O is a wheel), a target with Y = 0 is driven to without solving anything (6.5 divides by it),
// and of the points that 6.8 and 6.4 leave, the closest to S_i is S_i'.
[[nodiscard]] PublishedTurn published_turn(servo::Target target, Reading reading = Reading::as_printed);

}  // namespace forager::boards
