#pragma once

#include <cstdint>

#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "mocks/mavlink_peer.hpp"
#include "mocks/sim_autopilot_estimator.hpp"

namespace forager::mocks {

// What GUIDED flies, in the estimator's frame.
struct GuidedTarget {
  enum class Kind : std::uint8_t { hold, takeoff, position, velocity, position_velocity, acceleration };
  enum class Yaw : std::uint8_t { angle, rate };
  Kind kind = Kind::hold;  // hold: brake, then stay where it stopped
  bool stopped = false;    // position_ned_m is where it stopped
  hal::Vec3 position_ned_m;
  hal::Vec3 velocity_ned_m_s;
  hal::Vec3 acceleration_ned_m_s2;
  Yaw yaw = Yaw::angle;
  double yaw_rad = 0.0;  // clockwise, as all of NED
  double yaw_rate_rad_s = 0.0;
  hal::Instant heard;  // age of what expires

  // Everything but a position goes stale after GUID_TIMEOUT.
  [[nodiscard]] bool expires() const {
    return kind == Kind::velocity || kind == Kind::position_velocity || kind == Kind::acceleration;
  }
};

// Stands still where the estimate is now.
[[nodiscard]] GuidedTarget hold_here(const NedEstimate& estimate, hal::Instant now);

// SET_POSITION_TARGET_LOCAL_NED as ArduCopter 4.6 GUIDED reads it: frames 1, 7, 8, 9; offsets and body
// positions add to the present position; body vectors turn with the heading; any ignore bit of a triple
// ignores the triple. False: refused without effect (force). A frame or mask it cannot use makes it hold.
[[nodiscard]] bool decode_guided_target(const MavlinkPayload& message, const NedEstimate& estimate,
                                        hal::Instant now, GuidedTarget& target);

}  // namespace forager::mocks
