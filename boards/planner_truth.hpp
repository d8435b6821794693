#pragma once

#include <algorithm>
#include <cmath>

#include "boards/wide.hpp"
#include "hal/random.hpp"
#include "servo/turn_then_drive.hpp"

// Where a turn-then-drive plan really ends, to about 100 bits, and the targets it is asked for. Motion is
// composed step by step (roll, pivot about the wheel's contact point, roll), not solved for, so that an error
// of the closed form cannot hide in it.
namespace forager::boards {

struct WidePoint {
  Wide x;
  Wide y;
};

struct PlanValues {
  Wide roll_first;
  Wide turn;  // counter-clockwise positive
  Wide drive;
};

// The end of the three movements from the origin facing +x; pivot_y: the held wheel, +r or -r.
[[nodiscard]] inline WidePoint end_of(const PlanValues& plan, double pivot_y) {
  const WideDirection heading = direction(plan.turn);
  // The body's centre sits at -pivot_y across the held wheel and turns with it.
  const Wide arm = -Wide(pivot_y);
  const WidePoint turned{plan.roll_first - heading.sin * arm, Wide(pivot_y) + heading.cos * arm};
  return {turned.x + plan.drive * heading.cos, turned.y + plan.drive * heading.sin};
}

// With: the rests counted in. Without: what a controller does that takes the doubles alone.
enum class Rests { with, without };

[[nodiscard]] inline double miss_m(const servo::TurnThenDrive& plan, double half_track_m,
                                   servo::Target target, Rests rests) {
  const double keep = rests == Rests::with ? 1.0 : 0.0;
  const bool right = plan.brake == servo::Brake::right;
  PlanValues values{two_sum(plan.roll_first_m, keep * plan.rest.roll_first_m),
                    two_sum(plan.turn_rad, keep * plan.rest.turn_rad),
                    two_sum(plan.drive_m, keep * plan.rest.drive_m)};
  if (right) values.turn = -values.turn;
  const WidePoint end = end_of(values, right ? -half_track_m : half_track_m);
  return std::hypot((end.x - Wide(target.x_m)).rounded(), (end.y - Wide(target.y_m)).rounded());
}

[[nodiscard]] inline double distance_m(servo::Target target) { return std::hypot(target.x_m, target.y_m); }

// The four families of targets in turn; index picks the family. half_track_m in and 1e-12 .. 1e6 m away.
[[nodiscard]] inline servo::Target hard_target(hal::Random& random, unsigned index, double half_track_m) {
  const double side = random.chance(0.5) ? 1.0 : -1.0;
  const double range = std::pow(10.0, random.uniform(-12.0, 6.0));
  const double sliver = std::pow(10.0, random.uniform(-17.0, -1.0)) * (random.chance(0.5) ? 1.0 : -1.0);
  const double bearing = random.uniform(-hal::kPi, hal::kPi);
  servo::Target target;
  switch (index % 4) {
    case 0:  // anywhere within ten metres
      target = {random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
      break;
    case 1: {  // near the circle the body pivots on, from inside and outside
      const double radius = half_track_m * (1.0 + sliver);
      target = {radius * std::cos(bearing), side * (half_track_m + radius * std::sin(bearing))};
      break;
    }
    case 2:  // almost straight ahead or behind: turns near 0 and near 2 pi
      target = {side * range, range * sliver};
      break;
    default:  // every distance and bearing
      target = {range * std::cos(bearing), range * std::sin(bearing)};
  }
  return distance_m(target) < 1e-12 ? servo::Target{1e-12, 0.0} : target;
}

// 0.05 .. 5 m, log-uniform.
[[nodiscard]] inline double any_half_track_m(hal::Random& random) {
  return 0.05 * std::pow(100.0, random.uniform());
}

}  // namespace forager::boards
