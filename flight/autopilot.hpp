#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/halt.hpp"
#include "hal/pose.hpp"
#include "hal/pose_source.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// Fly to a place and face a way. World frame, REP-103.
struct PositionSetpoint {
  hal::Vec3 position_world;
  double yaw_rad = 0.0;      // (-pi, pi]
  hal::Instant valid_until;  // ignored from then on
};

// Fly with a velocity. Body heading frame: x forward, y left, z up.
struct VelocitySetpoint {
  hal::Vec3 velocity_body_m_s;
  double yaw_rate_rad_s = 0.0;  // positive: left
  hal::Instant valid_until;
};

enum class RequestState : std::uint8_t {
  none,      // nothing asked
  pending,   // sent, or being repeated
  accepted,  // the autopilot said yes
  refused,   // it said no, or never answered in all tries
};

// What the autopilot last said of itself. World frame, REP-103; times are when it arrived here.
struct AutopilotState {
  bool link_up = false;  // heartbeats are fresh
  hal::Instant last_heartbeat;
  bool guided = false;  // takes our setpoints
  std::uint32_t custom_mode = 0;
  bool armed = false;
  bool in_air = false;      // landed state says in air, taking off or landing
  bool pose_valid = false;  // position and attitude both fresh
  hal::Pose pose_world;     // the autopilot's own estimate
  hal::Vec3 velocity_world_m_s;
  std::optional<double> battery_fraction;  // 0..1
  std::string last_text;  // newest warning or worse it sent (the reason for a refused arming)
};

// An autopilot that flies goals. One request at a time; a new one replaces the one pending. Nothing moves
// without a fresh setpoint: a position or velocity is sent again and again until its valid_until, then no
// more, and the autopilot's own time-out (or its hold) takes over. Safe state: construction sends nothing but
// listens; halt() drops all setpoints and asks to land.
class Autopilot : public hal::Halt {
 public:
  virtual void update(hal::Instant now) = 0;
  [[nodiscard]] virtual const AutopilotState& state() const = 0;

  // Shows that the owner is alive: without a call in the deadman time our heartbeats and setpoints stop.
  virtual void feed_deadman(hal::Instant now) = 0;

  virtual void request_guided(hal::Instant now) = 0;
  virtual void request_arm(hal::Instant now) = 0;
  virtual void request_takeoff(double height_m, hal::Instant now) = 0;
  virtual void request_land(hal::Instant now) = 0;
  virtual void request_disarm(hal::Instant now) = 0;
  // Drops the request under way, as when a pilot took the vehicle: it is not repeated, its state is none.
  virtual void cancel_request() = 0;
  // How the last request stands, and for refused why ("arming refused: PreArm: ...").
  [[nodiscard]] virtual RequestState request_state() const = 0;
  [[nodiscard]] virtual const std::string& request_detail() const = 0;

  virtual void set_position(const PositionSetpoint& setpoint) = 0;
  virtual void set_velocity(const VelocitySetpoint& setpoint) = 0;
  virtual void clear_setpoint() = 0;

  // External localisation for the autopilot's estimator: already rate-limited and free of outliers.
  virtual void send_vision(const hal::PoseSample& sample) = 0;
};

}  // namespace forager::flight
