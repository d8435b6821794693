#include "flight/mavlink_setpoint.hpp"

#include <cmath>

#include "flight/frames.hpp"
#include "flight/mavlink/mavlink_wire.hpp"

namespace forager::flight {
namespace {

bool is_finite(const mavlink::SetPositionTargetLocalNed& t) {
  for (const float value : {t.x, t.y, t.z, t.vx, t.vy, t.vz, t.yaw, t.yaw_rate})
    if (!std::isfinite(value)) return false;
  return true;
}

bool same_goal(const mavlink::SetPositionTargetLocalNed& a, const mavlink::SetPositionTargetLocalNed& b) {
  return a.type_mask == b.type_mask && a.x == b.x && a.y == b.y && a.z == b.z && a.vx == b.vx &&
         a.vy == b.vy && a.vz == b.vz && a.yaw == b.yaw && a.yaw_rate == b.yaw_rate;
}

}  // namespace

mavlink::SetPositionTargetLocalNed to_target(const PositionSetpoint& setpoint) {
  const hal::Vec3 ned = flip_yz(setpoint.position_world);
  mavlink::SetPositionTargetLocalNed target;
  target.coordinate_frame = mavlink::frame_id::kLocalNed;
  target.type_mask = mavlink::target_mask::kPositionAndYaw;
  target.x = static_cast<float>(ned.x);
  target.y = static_cast<float>(ned.y);
  target.z = static_cast<float>(ned.z);
  target.yaw = static_cast<float>(flip_angle(setpoint.yaw_rad));
  return target;
}

mavlink::SetPositionTargetLocalNed to_target(const VelocitySetpoint& setpoint) {
  const hal::Vec3 frd = flip_yz(setpoint.velocity_body_m_s);
  mavlink::SetPositionTargetLocalNed target;
  target.coordinate_frame = mavlink::frame_id::kBodyNed;
  target.type_mask = mavlink::target_mask::kVelocityAndYawRate;
  target.vx = static_cast<float>(frd.x);
  target.vy = static_cast<float>(frd.y);
  target.vz = static_cast<float>(frd.z);
  target.yaw_rate = static_cast<float>(-setpoint.yaw_rate_rad_s);
  return target;
}

bool MavlinkSetpoint::set(const PositionSetpoint& setpoint) {
  return set(to_target(setpoint), setpoint.valid_until);
}
bool MavlinkSetpoint::set(const VelocitySetpoint& setpoint) {
  return set(to_target(setpoint), setpoint.valid_until);
}

bool MavlinkSetpoint::set(const mavlink::SetPositionTargetLocalNed& target, hal::Instant valid_until) {
  if (!is_finite(target)) {
    clear();
    return false;
  }
  if (!target_ || !same_goal(*target_, target)) next_.reset();
  target_ = target;
  valid_until_ = valid_until;
  return true;
}

bool MavlinkSetpoint::update(hal::Instant now) {
  if (!target_ || now < valid_until_) return false;
  clear();
  return true;
}

std::optional<mavlink::SetPositionTargetLocalNed> MavlinkSetpoint::due(hal::Instant now) {
  if (!target_ || now >= valid_until_ || (next_ && now < *next_)) return std::nullopt;
  // Steps of exactly one interval keep the rate when updates do not divide it; a late one starts anew.
  next_ = next_ && now - *next_ < interval_ ? *next_ + interval_ : now + interval_;
  return target_;
}

}  // namespace forager::flight
