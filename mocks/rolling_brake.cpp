#include "mocks/rolling_brake.hpp"

#include <algorithm>
#include <cmath>

namespace forager::mocks {

RollingBrake::RollingBrake(const RollingParameters& parameters)
    : parameters_(parameters),
      step_s_(hal::to_seconds(parameters.step)),
      blend_(-std::expm1(-step_s_ / std::max(parameters.servo_lag_s, 1e-6))),
      dead_steps_(std::min(kMostDead, static_cast<std::size_t>(
                                          std::lround(std::max(0.0, parameters.servo_dead_s / step_s_))))) {
  waiting_.fill(1.0);
}

void RollingBrake::step(double demand) {
  double target = std::isnan(demand) ? 1.0 : std::clamp(demand, 0.0, 1.0);
  if (dead_steps_ > 0) {
    std::swap(target, waiting_[at_]);
    at_ = (at_ + 1) % dead_steps_;
  }
  switch (fault_) {
    case BrakeFault::none:
      break;
    case BrakeFault::stuck_here:
      return;
    case BrakeFault::stuck_open:
      position_ = 0.0;
      return;
    case BrakeFault::stuck_locked:
      position_ = 1.0;
      return;
  }
  const double most = parameters_.servo_slew_1_s * step_s_;
  position_ += std::clamp(blend_ * (target - position_), -most, most);
}

double RollingBrake::force_n() const {
  const double touch = parameters_.brake_contact;
  const double pressed = std::clamp((position_ - touch) / (1.0 - touch), 0.0, 1.0);
  return grip_ * parameters_.brake_force_n * pressed;
}

}  // namespace forager::mocks
