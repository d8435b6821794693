#include "flight/mavlink_attitude.hpp"

#include <algorithm>
#include <cmath>

#include "flight/frames.hpp"
#include "flight/mavlink/mavlink_wire.hpp"

namespace forager::flight {
namespace {

constexpr double kSteepest = hal::deg_to_rad(80.0);

}  // namespace

mavlink::SetAttitudeTarget to_target(const AttitudeSetpoint& setpoint) {
  const double yaw = 0.5 * flip_angle(setpoint.yaw_rad);
  const double pitch = -0.5 * std::clamp(setpoint.pitch_rad, -kSteepest, kSteepest);
  mavlink::SetAttitudeTarget target;
  target.type_mask = mavlink::attitude_mask::kIgnoreRates;
  // Rz(yaw) Ry(pitch), w first.
  target.q = {static_cast<float>(std::cos(yaw) * std::cos(pitch)),
              static_cast<float>(-std::sin(yaw) * std::sin(pitch)),
              static_cast<float>(std::cos(yaw) * std::sin(pitch)),
              static_cast<float>(std::sin(yaw) * std::cos(pitch))};
  target.thrust = static_cast<float>(std::clamp(setpoint.thrust, 0.0, 1.0));
  return target;
}

bool MavlinkAttitude::set(const AttitudeSetpoint& setpoint) {
  if (!std::isfinite(setpoint.pitch_rad) || !std::isfinite(setpoint.yaw_rad) ||
      !std::isfinite(setpoint.thrust)) {
    clear();
    return false;
  }
  const mavlink::SetAttitudeTarget target = to_target(setpoint);
  if (!target_ || target_->thrust != target.thrust) next_.reset();
  target_ = target;
  valid_until_ = setpoint.valid_until;
  return true;
}

bool MavlinkAttitude::update(hal::Instant now) {
  if (!target_ || now < valid_until_) return false;
  clear();
  return true;
}

std::optional<mavlink::SetAttitudeTarget> MavlinkAttitude::due(hal::Instant now) {
  if (!target_ || now >= valid_until_ || (next_ && now < *next_)) return std::nullopt;
  next_ = next_ && now - *next_ < interval_ ? *next_ + interval_ : now + interval_;
  return target_;
}

}  // namespace forager::flight
