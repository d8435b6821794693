#include "flight/policy.hpp"

#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {

DecisionKind kind_of_turn(double turn_rad) {
  const double turn = hal::wrap_pi(turn_rad);
  if (std::abs(turn) < hal::deg_to_rad(45.0)) return DecisionKind::forward;
  if (std::abs(turn) > hal::deg_to_rad(135.0)) return DecisionKind::turn_back;
  return turn > 0.0 ? DecisionKind::turn_left : DecisionKind::turn_right;
}

Step step_along(double heading_rad, double length_m, const hal::Pose& from) {
  Step step = stay_at(from);
  step.kind = kind_of_turn(hal::angle_difference(heading_rad, from.yaw_rad));
  step.heading_rad = hal::wrap_pi(heading_rad);
  step.length_m = length_m;
  return step;
}

Step stay_at(const hal::Pose& from) {
  Step step;
  step.heading_rad = hal::wrap_pi(from.yaw_rad);
  return step;
}

Step land_now(const hal::Pose& from, EndReason why) {
  Step step = stay_at(from);
  step.kind = DecisionKind::land;
  step.end = why;
  return step;
}

}  // namespace forager::flight
