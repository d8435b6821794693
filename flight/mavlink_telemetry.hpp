#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "flight/autopilot.hpp"
#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages.hpp"
#include "flight/mavlink_config.hpp"
#include "hal/journal.hpp"

namespace forager::flight {

// Learns which component is the autopilot and turns what it says into AutopilotState.
class MavlinkTelemetry {
 public:
  MavlinkTelemetry(const MavlinkConfig& config, hal::Journal& journal);

  // True if the frame is from the autopilot (known, or learnt from this very heartbeat).
  bool take(const mavlink::Frame& frame, hal::Instant now);
  // Lets link and pose grow stale. True at the one update that finds the link back (or up for the first
  // time).
  bool update(hal::Instant now);

  [[nodiscard]] const AutopilotState& state() const { return state_; }
  [[nodiscard]] bool has_target() const { return sysid_.has_value(); }
  [[nodiscard]] std::uint8_t target_sysid() const { return sysid_.value_or(0); }
  [[nodiscard]] std::uint8_t target_compid() const { return compid_; }
  // Turn rate of the newest ATTITUDE, radians/s, positive left, and when it came.
  [[nodiscard]] double yaw_rate_rad_s() const { return yaw_rate_rad_s_; }
  [[nodiscard]] std::optional<hal::Instant> attitude_at() const { return attitude_at_; }
  // When the newest text of severity warning or worse came; with state().last_text.
  [[nodiscard]] std::optional<hal::Instant> last_warning() const { return last_warning_; }

 private:
  bool is_target(const mavlink::Frame& frame, hal::Instant now);
  void take_heartbeat(const mavlink::Heartbeat& heartbeat, hal::Instant now);
  void take_position(const mavlink::LocalPositionNed& position, hal::Instant now);
  void take_attitude(const mavlink::Attitude& attitude, hal::Instant now);
  void take_battery(int remaining_percent);
  void take_text(const mavlink::Statustext& text, hal::Instant now);
  [[nodiscard]] bool is_fresh(const std::optional<hal::Instant>& when, hal::Instant now) const {
    return when && now - *when < pose_timeout_;
  }

  hal::Journal* journal_;
  std::optional<std::uint8_t> sysid_;
  std::uint8_t compid_;
  std::uint32_t guided_mode_;
  hal::Duration link_timeout_;
  hal::Duration pose_timeout_;
  AutopilotState state_;
  bool heard_ = false;
  bool link_was_up_ = false;
  std::optional<hal::Instant> position_at_;
  std::optional<hal::Instant> attitude_at_;
  double yaw_rate_rad_s_ = 0.0;
  std::optional<hal::Instant> last_warning_;
  std::uint16_t chunk_id_ = 0;  // of the text being put together; 0: none
};

}  // namespace forager::flight
