#include "mocks/sim_autopilot_estimator.hpp"

#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {

using hal::Vec3;

SimEstimator::SimEstimator(const SimEstimatorConfig& config, std::uint64_t seed) : config_(config) {
  hal::Random random = hal::Random::stream(seed, 0x64726966);
  const double direction = random.uniform(-hal::kPi, hal::kPi);
  drift_direction_ = {std::cos(direction), std::sin(direction), 0.0};
}

Vec3 SimEstimator::to_ned(Vec3 world) const {
  return {cos_ * world.x + sin_ * world.y, sin_ * world.x - cos_ * world.y, -world.z};
}

Vec3 SimEstimator::to_world(Vec3 ned) const {
  return {cos_ * ned.x + sin_ * ned.y, sin_ * ned.x - cos_ * ned.y, -ned.z};
}

void SimEstimator::turn_by(double difference_rad) {
  if (difference_rad == difference_rad_) return;
  difference_rad_ = difference_rad;
  cos_ = std::cos(difference_rad);
  sin_ = std::sin(difference_rad);
}

bool SimEstimator::valid(hal::Instant now) const { return settled_ && now - *last_ <= config_.failsafe; }

void SimEstimator::propagate(const BodyState& truth, double dt_s, double yaw_drift_rad_s, hal::Instant now) {
  true_yaw_rad_ = truth.pose.yaw_rad;
  if (yaw_drift_rad_s != 0.0) turn_by(hal::wrap_pi(difference_rad_ - yaw_drift_rad_s * dt_s));
  estimate_.yaw_rad = hal::wrap_pi(difference_rad_ - true_yaw_rad_);
  if (!truth.on_ground && !healthy(now))
    velocity_error_ = velocity_error_ + (config_.drift_m_s2 * dt_s) * drift_direction_;
  if (truth.on_ground) velocity_error_ = {};
  const Vec3 before = estimate_.velocity_m_s;
  estimate_.velocity_m_s = to_ned(truth.velocity_world_m_s) + velocity_error_;
  estimate_.position_m = estimate_.position_m + (0.5 * dt_s) * (before + estimate_.velocity_m_s);
  if (!settled_ && first_ && healthy(now) && now - *first_ >= config_.settle) settled_ = true;
}

std::optional<EstimateShift> SimEstimator::fuse(const VisionSample& sample, hal::Instant now) {
  if (last_ && now - *last_ < config_.shortest) {
    ++dropped_;
    return std::nullopt;
  }
  ++samples_;
  const Vec3 off = sample.position_ned_m - estimate_.position_m;
  const double turn = hal::angle_difference(sample.yaw_rad, estimate_.yaw_rad);
  const bool at_once = !settled_ || sample.reset_counter != reset_counter_;
  const double gap_s = last_ ? hal::to_seconds(now - *last_) : 0.0;
  if (!healthy(now)) first_ = now;
  last_ = now;
  reset_counter_ = sample.reset_counter;
  const double share = at_once ? 1.0 : -std::expm1(-gap_s / config_.blend_s);
  estimate_.position_m = estimate_.position_m + share * off;
  velocity_error_ = (1.0 - share) * velocity_error_;
  turn_by(hal::wrap_pi(difference_rad_ + share * turn));
  estimate_.yaw_rad = hal::wrap_pi(difference_rad_ - true_yaw_rad_);
  if (!at_once) return std::nullopt;
  return EstimateShift{off, turn};
}

}  // namespace forager::mocks
