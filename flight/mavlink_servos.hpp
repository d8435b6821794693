#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "flight/mavlink/messages_command.hpp"
#include "flight/mavlink_config.hpp"
#include "hal/pwm.hpp"

namespace forager::flight {

class MavlinkServos;

// One output of the autopilot that it leaves to us (SERVOn_FUNCTION 0 or 1), as a PWM channel. Pulses are
// whole microseconds. A set is queued and sent by the autopilot bridge; what came of it shows at the next
// set: refused (the output has another function), timeout (no acknowledgement in all tries). Without a link a
// set answers disconnected, and is sent all the same when the link is back: the newest pulse is what the
// output is to make, and an older one must not come back in its place.
class MavlinkServo final : public hal::PwmChannel {
 private:
  friend class MavlinkServos;
  hal::Result<> do_set_pulse(hal::Duration length) override;
  hal::Result<> do_release() override;
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }
  hal::Result<> want(std::uint16_t us);

  MavlinkServos* servos_ = nullptr;
  std::uint8_t output_ = 0;  // from 1
  std::string name_;
  std::optional<std::uint16_t> wanted_us_;  // 0: no pulses; nothing: never told
  std::optional<std::uint16_t> acked_us_;
  std::optional<hal::Error> failure_;
  std::uint16_t sent_us_ = 0;
  int tries_ = 0;  // unanswered; 0: nothing under way
  hal::Instant next_try_;
  std::uint64_t sent_as_ = 0;  // number of the newest try
};

// MAV_CMD_DO_SET_SERVO for the outputs 1 to 16 of one ArduPilot. Changed pulses go first, and every output
// that was told one is told again each refresh interval, as an autopilot that was restarted knows nothing of
// it.
//
// An acknowledgement does not say which output it is for, so the next command waits for the answer to the one
// before, but not for long: a lost one must not keep the other brake waiting. When two are unanswered an
// acknowledgement counts for the newer one and the older is told again; a refusal counts for neither.
//
// Crash: the autopilot keeps the last pulse for as long as it runs.
class MavlinkServos {
 public:
  static constexpr hal::Duration kRefresh = std::chrono::milliseconds(500);
  static constexpr hal::Duration kTurn = std::chrono::milliseconds(100);  // of one output, unanswered

  explicit MavlinkServos(const MavlinkConfig& config);

  // 1 to 16, as in the autopilot's parameters; another number throws std::out_of_range.
  [[nodiscard]] MavlinkServo& output(std::size_t number) { return outputs_.at(number - 1); }

  void set_link(bool up) { link_up_ = up; }
  // The command to send now.
  [[nodiscard]] std::optional<mavlink::CommandLong> due(hal::Instant now);
  // An ack meant for us; those of other commands change nothing.
  void take(const mavlink::CommandAck& ack);
  // The autopilot is a new one, or was restarted.
  void forget();

 private:
  friend class MavlinkServo;
  [[nodiscard]] MavlinkServo* next(hal::Instant now);
  void give_up(hal::Instant now);
  // The one whose try is the newest unanswered one; null: none.
  [[nodiscard]] MavlinkServo* newest_unanswered();
  void finish(MavlinkServo& servo, std::optional<hal::Error> failure);

  hal::Duration timeout_;
  int max_tries_;
  std::array<MavlinkServo, 16> outputs_;
  std::array<hal::Instant, 16> told_at_{};
  bool link_up_ = false;
  std::optional<hal::Instant> turn_ends_;  // nothing: the newest command was answered
  std::uint64_t sent_ = 0;
  std::size_t turn_ = 0;  // where the search for the next one begins: nobody starves
};

}  // namespace forager::flight
