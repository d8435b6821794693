#include "mocks/sim_autopilot_target.hpp"

#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

using hal::Vec3;

Vec3 triple(const MavlinkPayload& m, std::size_t offset) {
  return {m.f32(offset), m.f32(offset + 4), m.f32(offset + 8)};
}

// Yaw or its rate; neither keeps the heading (WP_YAW_BEHAVIOR 0, the setting for indoors).
void decode_yaw(const MavlinkPayload& m, std::uint16_t mask, bool relative, const NedEstimate& estimate,
                GuidedTarget& target) {
  const bool use_yaw = (mask & peer::kIgnoreYaw) == 0 && std::isfinite(m.f32(40));
  const bool use_rate = (mask & peer::kIgnoreYawRate) == 0 && std::isfinite(m.f32(44));
  target.yaw = !use_yaw && use_rate ? GuidedTarget::Yaw::rate : GuidedTarget::Yaw::angle;
  target.yaw_rate_rad_s = use_rate ? m.f32(44) : 0.0;
  target.yaw_rad = estimate.yaw_rad;
  if (use_yaw) target.yaw_rad = hal::wrap_pi(m.f32(40) + (relative ? estimate.yaw_rad : 0.0));
}

}  // namespace

GuidedTarget hold_here(const NedEstimate& estimate, hal::Instant now) {
  GuidedTarget target;
  target.position_ned_m = estimate.position_m;
  target.yaw_rad = estimate.yaw_rad;
  target.heard = now;
  return target;
}

bool decode_guided_target(const MavlinkPayload& m, const NedEstimate& estimate, hal::Instant now,
                          GuidedTarget& target) {
  using Kind = GuidedTarget::Kind;
  const auto mask = m.get<std::uint16_t>(48);
  const auto frame = m.get<std::uint8_t>(52);
  const bool position = (mask & peer::kIgnorePosition) == 0;
  const bool velocity = (mask & peer::kIgnoreVelocity) == 0;
  const bool acceleration = (mask & peer::kIgnoreAcceleration) == 0;
  if ((mask & peer::kForceSet) != 0 && acceleration) return false;
  const bool body = frame == peer::kBodyNed || frame == peer::kBodyOffsetNed;
  const bool known = body || frame == peer::kLocalNed || frame == peer::kLocalOffsetNed;

  GuidedTarget made = hold_here(estimate, now);
  const auto turned = [&](Vec3 v) { return body ? hal::rotate_yaw(v, estimate.yaw_rad) : v; };
  if (position && velocity)
    made.kind = Kind::position_velocity;
  else if (velocity)
    made.kind = Kind::velocity;
  else if (position && !acceleration)
    made.kind = Kind::position;
  else if (acceleration && !position)
    made.kind = Kind::acceleration;
  const Vec3 place = turned(triple(m, 4));
  const Vec3 speed = turned(triple(m, 16));
  const Vec3 push = turned(triple(m, 28));
  const bool finite = (!position || hal::is_finite(place)) && (!velocity || hal::is_finite(speed)) &&
                      (!acceleration || hal::is_finite(push));
  if (!known || !finite || made.kind == Kind::hold) {
    target = hold_here(estimate, now);
    return true;
  }
  if (position) made.position_ned_m = frame == peer::kLocalNed ? place : estimate.position_m + place;
  if (velocity) made.velocity_ned_m_s = speed;
  if (made.kind == Kind::acceleration) {
    made.velocity_ned_m_s = estimate.velocity_m_s;
    made.acceleration_ned_m_s2 = push;
  }
  decode_yaw(m, mask, body, estimate, made);
  target = made;
  return true;
}

}  // namespace forager::mocks
