#include "flight/baseline_static.hpp"

#include <algorithm>

namespace forager::flight {

Step Static::begin(const hal::Pose& pose_world) {
  heading_rad_ = pose_world.yaw_rad;
  Step step = stay_at(pose_world);
  step.height_m = config_.height_m;
  step.listen = std::min(config_.window, config_.mission_time);
  return step;
}

Step Static::decide(const Observation& seen) {
  const hal::Duration left = config_.mission_time - seen.elapsed;
  Step step = left > hal::Duration::zero() ? stay_at(seen.pose_world)
                                           : land_now(seen.pose_world, EndReason::time_limit);
  step.heading_rad = heading_rad_;  // the first one: no creeping along with the yaw noise
  step.height_m = config_.height_m;
  step.listen = std::clamp(left, hal::Duration::zero(), config_.window);
  return step;
}

}  // namespace forager::flight
