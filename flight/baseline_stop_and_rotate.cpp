#include "flight/baseline_stop_and_rotate.hpp"

#include "hal/units.hpp"

namespace forager::flight {

Step StopAndRotate::begin(const hal::Pose& pose_world) {
  course_rad_ = pose_world.yaw_rad;
  Step step = stay_at(pose_world);
  step.height_m = config_.height_m;
  step.listen = config_.window;
  return step;
}

// The way of one window: reads on it are the window, so nothing is listened for at its end.
Step StopAndRotate::drive(double heading_rad, const hal::Pose& here) const {
  Step step = step_along(heading_rad, config_.speed_m_s * hal::to_seconds(config_.window), here);
  step.speed_m_s = config_.speed_m_s;
  return step;
}

Step StopAndRotate::decide(const Observation& seen) {
  quiet_ = seen.fresh_tags > 0 ? 0 : quiet_ + 1;
  Step step;
  if (quiet_ >= config_.tries) {
    step = land_now(seen.pose_world, EndReason::no_new_tags);
  } else if (rotating_ ? seen.fresh_tags >= config_.rotate_below : seen.fresh_tags > config_.rotate_above) {
    rotating_ = true;
    step = step_along(seen.pose_world.yaw_rad + config_.rotation_step_rad, 0.0, seen.pose_world);
    step.listen = config_.window;
  } else {
    rotating_ = false;
    if (seen.blocked) course_rad_ = hal::wrap_pi(seen.pose_world.yaw_rad + hal::kPi / 2.0);
    step = drive(course_rad_, seen.pose_world);
    if (seen.blocked) step.listen = config_.window;
  }
  step.height_m = config_.height_m;
  return step;
}

}  // namespace forager::flight
