#pragma once

#include <optional>

#include "flight/autopilot.hpp"

namespace forager::flight {

// Tilt and push: what drives a vehicle that rolls. World frame, REP-103.
struct AttitudeSetpoint {
  double pitch_rad = 0.0;    // nose down positive
  double yaw_rad = 0.0;      // the heading it has: the motors are not to turn it
  double thrust = 0.0;       // 0..1 of full
  hal::Instant valid_until;  // not sent from then on
};

// What a rolling vehicle needs of its autopilot besides what a flying one does. An attitude replaces a
// position or velocity and the other way round. The autopilot's own time-out must be short and must end in a
// level body: with ArduCopter set GUID_TIMEOUT to less than a second and GUID_OPTIONS bit 3, so that thrust
// is thrust and not a climb rate.
class DriveAutopilot : public Autopilot {
 public:
  // Not finite: dropped, and so is what was in force. Values outside their range are clamped.
  virtual void set_attitude(const AttitudeSetpoint& setpoint) = 0;
  // The gyro's, positive left; the newest since the last call, or nothing.
  [[nodiscard]] virtual std::optional<double> take_yaw_rate() = 0;
  // When attitude was last heard: much fresher than heartbeats at 1 Hz. Minimum: never.
  [[nodiscard]] virtual hal::Instant attitude_heard() const = 0;
  // Disarms at once, whatever the autopilot's land detector believes. For a vehicle on its wheels only.
  virtual void request_stop_motors(hal::Instant now) = 0;
  // Sends what was set or asked for since update(), if it is due: a cut of thrust does not wait for the next.
  virtual void send(hal::Instant now) = 0;
  // Somebody told us over the link to stop at once (a disarm command addressed to this computer). Stays.
  [[nodiscard]] virtual bool stop_heard() const = 0;
};

}  // namespace forager::flight
