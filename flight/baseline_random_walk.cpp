#include "flight/baseline_random_walk.hpp"

#include "hal/units.hpp"

namespace forager::flight {

Step RandomWalk::begin(const hal::Pose& pose_world) {
  Step step = stay_at(pose_world);
  step.height_m = config_.height_m;
  step.listen = config_.window;
  return step;
}

Step RandomWalk::decide(const Observation& seen) {
  Step step = seen.elapsed < config_.mission_time
                  ? step_along(random_.uniform(-hal::kPi, hal::kPi), config_.step_m, seen.pose_world)
                  : land_now(seen.pose_world, EndReason::time_limit);
  step.height_m = config_.height_m;
  step.listen = config_.window;
  return step;
}

}  // namespace forager::flight
