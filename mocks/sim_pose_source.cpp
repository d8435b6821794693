#include "mocks/sim_pose_source.hpp"

#include <cmath>

namespace forager::mocks {

void SimPoseSource::jump(hal::Vec3 offset_world, double yaw_rad, bool announced) {
  offset_ = offset_ + offset_world;
  yaw_offset_rad_ = hal::wrap_pi(yaw_offset_rad_ + yaw_rad);
  if (announced) ++resets_;
}

hal::Result<std::optional<hal::PoseSample>> SimPoseSource::do_poll(hal::Instant now) {
  if (fault_ == PoseFault::disconnect)
    return hal::fail(hal::ErrorCode::disconnected, "simulated tracking camera", "read pose",
                     "the cable is out", "plug it in again");
  if (next_sample_ && now < *next_sample_) return std::optional<hal::PoseSample>{};
  const hal::Instant due = next_sample_.value_or(now);
  const double dt_s = next_sample_ ? hal::to_seconds(now - last_.stamp) : 0.0;
  next_sample_ = due + ((now - due) / options_.period + 1) * options_.period;

  hal::PoseSample sample = measure(now, dt_s);
  const bool lost = dropped_out(now, dt_s) || fault_ == PoseFault::lost;
  if (lost || fault_ == PoseFault::freeze) sample.pose = last_.pose;
  if (lost) sample.confidence = hal::PoseConfidence::failed;
  last_ = sample;
  if (fault_ == PoseFault::stall) return std::optional<hal::PoseSample>{};
  return std::optional<hal::PoseSample>{sample};
}

hal::PoseSample SimPoseSource::measure(hal::Instant now, double dt_s) {
  const double step = std::sqrt(dt_s);
  const auto draw3 = [&](double sigma) {
    const double x = random_.normal();
    const double y = random_.normal();
    const double z = random_.normal();
    return hal::Vec3{sigma * x, sigma * y, sigma * z};
  };
  offset_ = offset_ + draw3(options_.drift_m_per_sqrt_s * step);
  yaw_offset_rad_ =
      hal::wrap_pi(yaw_offset_rad_ + options_.yaw_drift_rad_per_sqrt_s * step * random_.normal());

  const BodyState& truth = body_->state();
  const hal::Vec3 angles = draw3(options_.angle_noise_rad);
  hal::PoseSample sample;
  sample.stamp = now;
  sample.reset_counter = resets_;
  sample.pose.position = truth.pose.position + offset_ + draw3(options_.position_noise_m);
  sample.pose.yaw_rad = hal::wrap_pi(truth.pose.yaw_rad + yaw_offset_rad_ + angles.z);
  sample.pose.pitch_rad = truth.pose.pitch_rad + angles.y;
  sample.pose.roll_rad = truth.pose.roll_rad + angles.x;
  sample.confidence = std::abs(truth.yaw_rate_rad_s) > options_.low_confidence_yaw_rate_rad_s
                          ? hal::PoseConfidence::low
                          : hal::PoseConfidence::high;
  return sample;
}

bool SimPoseSource::dropped_out(hal::Instant now, double dt_s) {
  if (options_.dropouts_per_s > 0.0 && random_.chance(-std::expm1(-options_.dropouts_per_s * dt_s)))
    dropout_until_ = now + options_.dropout_length;
  return dropout_until_ && now < *dropout_until_;
}

}  // namespace forager::mocks
