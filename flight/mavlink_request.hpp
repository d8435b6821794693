#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "flight/autopilot.hpp"
#include "flight/mavlink/messages_command.hpp"
#include "flight/mavlink_config.hpp"

namespace forager::flight {

// One command at a time through the command protocol of MAVLink:
//
//   none/accepted/refused --begin--> pending --ack ACCEPTED--> accepted; any --cancel--> none
//     pending: sent again with confirmation + 1 after each timeout; IN_PROGRESS lengthens the wait;
//              TEMPORARILY_REJECTED waits for the next try
//     pending --other ack, then its STATUSTEXT or a short wait--> refused
//     pending --all tries unanswered--> refused
//
// A change of mode is also accepted when a heartbeat shows it. When it replaces another change of mode still
// pending, only the heartbeat counts: an ack could be that of the command before.
class MavlinkRequest {
 public:
  explicit MavlinkRequest(const MavlinkConfig& config);

  // `what` is for people: "arming". The string must outlive the request (a literal).
  void begin(std::string_view what, const mavlink::CommandLong& command, hal::Instant now);
  // Refuses at once what makes no sense to send.
  void refuse(std::string_view what, std::string_view why);

  // Forgets it: not sent any more, and an answer to it changes nothing.
  void cancel();

  // The command to send now, or nullptr.
  [[nodiscard]] const mavlink::CommandLong* due(hal::Instant now);
  // An ack from the autopilot that may be meant for us; those of other commands change nothing.
  void take(const mavlink::CommandAck& ack, hal::Instant now);
  void update(const AutopilotState& autopilot, std::optional<hal::Instant> last_warning, hal::Instant now);

  [[nodiscard]] RequestState state() const { return state_; }
  [[nodiscard]] const std::string& detail() const { return detail_; }
  [[nodiscard]] std::string_view what() const { return what_; }

 private:
  [[nodiscard]] bool is_mode_change() const;
  void finish_refused(std::string_view why);

  hal::Duration timeout_;
  hal::Duration progress_timeout_;
  hal::Duration reason_timeout_;
  int max_tries_;

  RequestState state_ = RequestState::none;
  std::string detail_;
  std::string_view what_;
  mavlink::CommandLong command_;
  int tries_ = 0;
  bool only_heartbeat_counts_ = false;
  hal::Instant begun_{};
  hal::Instant next_try_{};
  std::optional<std::uint8_t> refusal_;  // the result of a refusing ack whose reason is still awaited
  hal::Instant refused_at_{};
};

}  // namespace forager::flight
