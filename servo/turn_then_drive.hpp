#pragma once

#include <cstdint>
#include <string_view>

#include "hal/error.hpp"
#include "hal/units.hpp"

// Turn-then-drive: a vehicle that is pushed forward and steered by braking one wheel reaches a point by
// pivoting about the braked wheel until it faces the point, then rolling straight. The printed equations 6.5
// to 6.10 of the thesis do not do that (docs/driving.md counts how often); what follows is the closed form.
//
// Body frame: x forward, y left, metres, the origin between the wheels, r half the track. Left brake, target
// (X, Y):  q = X^2 + Y (Y - 2r),  drive D = sqrt(q),  turn Delta = 2 atan2(Y, X + D)  to the left; the right
// brake is the mirror image. q < 0: the point lies inside the circle around the wheel that the body pivots
// on, and no turn about that wheel faces it. It never lies inside both circles.
namespace forager::servo {

// A point in the body frame at the moment of planning.
struct Target {
  double x_m = 0.0;
  double y_m = 0.0;
  bool operator==(const Target&) const = default;
};

enum class Brake : std::uint8_t { none, left, right };
[[nodiscard]] std::string_view to_string(Brake brake);

// One way to the target: roll straight on, hold one wheel until turned, roll straight on.
struct TurnThenDrive {
  Brake brake = Brake::none;   // left turns to the left; none: no turn
  bool inside_circle = false;  // not reachable about this wheel without rolling first
  double roll_first_m = 0.0;   // >= 0; 0 unless inside_circle
  double turn_rad = 0.0;       // 0 .. 2 pi, towards the brake's side
  double drive_m = 0.0;        // >= 0
  bool operator==(const TurnThenDrive&) const = default;

  // What the three doubles above leave over, for who needs the last micrometre of a nanometre: a turn short
  // of a full circle by 1e-6 rad has lost ten digits of that in a double. Zero or below half a unit in the
  // last place; no controller needs them.
  struct Rest {
    double roll_first_m = 0.0;
    double turn_rad = 0.0;
    double drive_m = 0.0;
    bool operator==(const Rest&) const = default;
  } rest = {};

  // Counter-clockwise positive: left brake +, right brake -.
  [[nodiscard]] double signed_turn_rad() const { return brake == Brake::right ? -turn_rad : turn_rad; }
};

// Why there is no way although the target is finite.
enum class NoWay : std::uint8_t {
  none,            // there is one
  no_brake,        // a turn is needed and neither brake may be used
  inside_circle,   // only by rolling first, which is not allowed
  turn_too_large,  // the smallest turn exceeds the limit
  too_far,         // the distance is not a finite double
};
[[nodiscard]] std::string_view to_string(NoWay reason);  // "inside the pivot circle", ...

enum class RollFirst : std::uint8_t {
  never,
  if_needed,       // when no allowed brake reaches the target otherwise
  if_shorter_turn  // also when it makes the turn smaller
};

struct TurnConfig {
  double half_track_m = 0.5;  // r: 1 mm .. 1 km
  // Straight ahead is |Y| <= straight_band * X: no turn then, and the vehicle passes the target at a distance
  // of at most straight_band * X. The default is what keeps every end point within 1e-12 of its target.
  double straight_band = 1e-12;          // 0 .. 1
  double max_turn_rad = 2.0 * hal::kPi;  // 0 .. 2 pi
  RollFirst roll_first = RollFirst::if_needed;
  bool left_brake = true;  // may be used
  bool right_brake = true;
  bool operator==(const TurnConfig&) const = default;
};

struct TurnPlan {
  TurnThenDrive left = {};  // about the left wheel, whether allowed or not
  TurnThenDrive right = {};
  TurnThenDrive
      chosen;  // the allowed one with the smaller turn, left if they are equal; valid if no_way is none
  NoWay no_way = NoWay::none;
};

// Plans from standing at the origin facing +x. Total: every finite target gives a plan or a reason. Allocates
// nothing unless it fails.
//
// Accuracy: doing roll_first, turn and drive with their rests exactly ends within 1e-12 |target| of the
// target, for |target| from 1e-12 to 1e6 m and r from 0.05 to 5 m. With the doubles alone that holds from
// |target| >= r / 500; nearer targets are met to within 2e-15 r, which is all a turn near 2 pi can say.
//
// Errors: invalid_argument: target not finite (lost pose, overflow upstream), half track not within 1 mm ..
// 1 km (units), or another entry of config outside its range.
[[nodiscard]] hal::Result<TurnPlan> plan_turn_then_drive(Target target, const TurnConfig& config);

}  // namespace forager::servo
