#include "flight/baseline_dead_reckoning.hpp"

#include <cmath>

namespace forager::flight {

Step DeadReckoning::begin(const hal::Pose& pose_world) {
  Step step = stay_at(pose_world);
  step.height_m = config_.height_m;
  return step;
}

Step DeadReckoning::decide(const Observation& seen) {
  const hal::Vec3 here = seen.pose_world.position;
  const bool held_up =
      waiting_ ? seen.way_ahead != WayAhead::clear : seen.blocked && seen.moved_m < config_.reached_m;
  blocked_looks_ = held_up ? blocked_looks_ + 1 : 0;
  if (blocked_looks_ >= config_.patience) {
    blocked_looks_ = 0;
    ++next_;
  }
  waiting_ = false;
  while (next_ < config_.waypoints_world.size() &&
         hal::distance_xy(config_.waypoints_world[next_], here) <= config_.reached_m)
    ++next_;
  Step step;
  if (next_ >= config_.waypoints_world.size()) {
    step = land_now(seen.pose_world, EndReason::path_complete);
  } else {
    const hal::Vec3 way = config_.waypoints_world[next_] - here;
    step = step_along(std::atan2(way.y, way.x), std::hypot(way.x, way.y), seen.pose_world);
    step.speed_m_s = config_.speed_m_s;
    if (blocked_looks_ > 0 && seen.way_ahead != WayAhead::clear) {
      waiting_ = true;
      step.length_m = 0.0;
      step.kind = DecisionKind::stay;
      step.listen = config_.wait;
    }
  }
  step.height_m = config_.height_m;
  return step;
}

}  // namespace forager::flight
