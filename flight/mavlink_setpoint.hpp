#pragma once

#include <optional>

#include "flight/autopilot.hpp"
#include "flight/mavlink/messages_setpoint.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// SET_POSITION_TARGET_LOCAL_NED for ArduCopter GUIDED. Positions in LOCAL_NED with yaw (type_mask 0x09F8),
// velocities in BODY_NED with yaw rate (0x05C7): the autopilot turns them by its own, fresher heading.
[[nodiscard]] mavlink::SetPositionTargetLocalNed to_target(const PositionSetpoint& setpoint);
[[nodiscard]] mavlink::SetPositionTargetLocalNed to_target(const VelocitySetpoint& setpoint);

// Holds the one setpoint in force and says when to send it: at once when it changes, then again and again at
// the interval, never from its valid_until on.
class MavlinkSetpoint {
 public:
  explicit MavlinkSetpoint(hal::Duration interval) : interval_(interval) {}

  // A setpoint that is not finite clears what was there, as nobody knows what was meant: false.
  bool set(const PositionSetpoint& setpoint);
  bool set(const VelocitySetpoint& setpoint);
  void clear() { target_.reset(); }
  [[nodiscard]] bool is_set() const { return target_.has_value(); }

  // True at the one update at which the setpoint ran out.
  bool update(hal::Instant now);
  // What to send now, without target ids and time, or nullopt.
  [[nodiscard]] std::optional<mavlink::SetPositionTargetLocalNed> due(hal::Instant now);

 private:
  bool set(const mavlink::SetPositionTargetLocalNed& target, hal::Instant valid_until);

  hal::Duration interval_;
  std::optional<mavlink::SetPositionTargetLocalNed> target_;
  hal::Instant valid_until_{};
  std::optional<hal::Instant> next_;  // nullopt: at once
};

}  // namespace forager::flight
