#pragma once

#include <optional>

#include "flight/drive_autopilot.hpp"
#include "flight/mavlink/messages_setpoint.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// SET_ATTITUDE_TARGET for ArduCopter GUIDED: attitude and thrust, body rates ignored (type_mask 0x07; it
// wants all three or none), quaternion NED <- FRD, roll 0.
[[nodiscard]] mavlink::SetAttitudeTarget to_target(const AttitudeSetpoint& setpoint);

// Holds the attitude in force and says when to send it: at once when thrust changes, then at the interval,
// never from its valid_until on.
class MavlinkAttitude {
 public:
  explicit MavlinkAttitude(hal::Duration interval) : interval_(interval) {}

  // False, and nothing in force any more, for a setpoint that is not finite.
  bool set(const AttitudeSetpoint& setpoint);
  void clear() { target_.reset(); }
  [[nodiscard]] bool is_set() const { return target_.has_value(); }
  // True at the one update at which it ran out.
  bool update(hal::Instant now);
  [[nodiscard]] std::optional<mavlink::SetAttitudeTarget> due(hal::Instant now);

 private:
  hal::Duration interval_;
  std::optional<mavlink::SetAttitudeTarget> target_;
  hal::Instant valid_until_{};
  std::optional<hal::Instant> next_;  // nullopt: at once
};

}  // namespace forager::flight
