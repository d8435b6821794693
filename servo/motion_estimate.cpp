#include "servo/motion_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::servo {

// White acceleration noise of density noise^2 (m/s^2, held for about a sample of 33 ms).
void MotionEstimate::Covariance::grow(double dt, double noise) {
  constexpr double kHeld = 0.033;
  const double q = noise * noise * kHeld;
  value += dt * (2.0 * cross + dt * (rate + q * dt / 3.0));
  cross += dt * (rate + 0.5 * q * dt);
  rate += q * dt;
}

void MotionEstimate::Covariance::measure_value(double gain_value, double gain_rate) {
  rate -= gain_rate * cross;
  cross *= 1.0 - gain_value;
  value *= 1.0 - gain_value;
}

void MotionEstimate::start(const hal::PoseSample& sample) {
  pose_ = sample.pose;
  pose_.yaw_rad = hal::wrap_pi(pose_.yaw_rad);
  speed_ = yaw_rate_ = 0.0;
  along_ = {config_.position_noise_m * config_.position_noise_m, 0.0, 0.04};
  turn_ = {config_.yaw_noise_rad * config_.yaw_noise_rad, 0.0, 0.04};
  reset_counter_ = sample.reset_counter;
}

void MotionEstimate::predict(hal::Instant now, double accel_m_s2, double yaw_accel_rad_s2) {
  const hal::Duration step = std::clamp(now - now_, hal::Duration::zero(), config_.longest_step);
  now_ = now;
  predicted_ = true;
  if (!last_pose_ || step == hal::Duration::zero()) return;
  const double dt = hal::to_seconds(step);
  const double speed = speed_ + dt * accel_m_s2;
  const double yaw_rate = yaw_rate_ + dt * yaw_accel_rad_s2;
  const double turn = 0.5 * dt * (yaw_rate + yaw_rate_);
  const double way = 0.5 * dt * (speed + speed_);
  pose_.position.x += way * std::cos(pose_.yaw_rad + 0.5 * turn);
  pose_.position.y += way * std::sin(pose_.yaw_rad + 0.5 * turn);
  pose_.yaw_rad = hal::wrap_pi(pose_.yaw_rad + turn);
  speed_ = speed;
  yaw_rate_ = yaw_rate;
  along_.grow(dt, config_.accel_noise_m_s2);
  turn_.grow(dt, config_.yaw_accel_noise_rad_s2);
}

bool MotionEstimate::take(const hal::PoseSample& sample) {
  const bool usable = hal::is_finite(sample.pose.position) && std::isfinite(sample.pose.yaw_rad) &&
                      sample.confidence != hal::PoseConfidence::failed &&
                      (!last_pose_ || sample.stamp > *last_pose_) &&
                      (!predicted_ || sample.stamp - now_ <= config_.most_ahead);
  if (!usable) return false;
  const bool moved = last_pose_ && sample.reset_counter != reset_counter_;
  const bool first = !last_pose_;
  last_pose_ = sample.stamp;
  if (first || moved) {
    start(sample);
    if (moved) ++resets_;
    return true;
  }
  const double age = std::clamp(hal::to_seconds(now_ - sample.stamp), 0.0, 0.5);
  const double c = std::cos(pose_.yaw_rad);
  const double s = std::sin(pose_.yaw_rad);
  const double miss_x = sample.pose.position.x - (pose_.position.x - age * speed_ * c);
  const double miss_y = sample.pose.position.y - (pose_.position.y - age * speed_ * s);
  const double miss_yaw = hal::angle_difference(sample.pose.yaw_rad, pose_.yaw_rad - age * yaw_rate_);

  const double sum = along_.value + config_.position_noise_m * config_.position_noise_m;
  const double gain = along_.value / sum;
  const double gain_speed = along_.cross / sum;
  pose_.position.x += gain * miss_x;
  pose_.position.y += gain * miss_y;
  pose_.position.z = sample.pose.position.z;
  pose_.pitch_rad = sample.pose.pitch_rad;
  pose_.roll_rad = sample.pose.roll_rad;
  speed_ += gain_speed * (miss_x * c + miss_y * s);
  along_.measure_value(gain, gain_speed);

  const double yaw_sum = turn_.value + config_.yaw_noise_rad * config_.yaw_noise_rad;
  const double yaw_gain = turn_.value / yaw_sum;
  const double yaw_gain_rate = turn_.cross / yaw_sum;
  pose_.yaw_rad = hal::wrap_pi(pose_.yaw_rad + yaw_gain * miss_yaw);
  yaw_rate_ += yaw_gain_rate * miss_yaw;
  turn_.measure_value(yaw_gain, yaw_gain_rate);
  return true;
}

void MotionEstimate::take_yaw_rate(double rate_rad_s) {
  if (!last_pose_ || !std::isfinite(rate_rad_s)) return;
  const double sum = turn_.rate + config_.yaw_rate_noise_rad_s * config_.yaw_rate_noise_rad_s;
  const double gain = turn_.rate / sum;
  const double gain_yaw = turn_.cross / sum;
  const double miss = rate_rad_s - yaw_rate_;
  pose_.yaw_rad = hal::wrap_pi(pose_.yaw_rad + gain_yaw * miss);
  yaw_rate_ += gain * miss;
  turn_.value -= gain_yaw * turn_.cross;
  turn_.cross *= 1.0 - gain;
  turn_.rate *= 1.0 - gain;
}

void MotionEstimate::stand() {
  speed_ = yaw_rate_ = 0.0;
  along_.rate = std::min(along_.rate, 1e-4);
  turn_.rate = std::min(turn_.rate, 1e-4);
  along_.cross = turn_.cross = 0.0;
}

}  // namespace forager::servo
