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
// set answers disconnected and nothing is kept.
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
};

// MAV_CMD_DO_SET_SERVO for the outputs 1 to 16 of one ArduPilot. An acknowledgement does not say which output
// it is for, so one command is under way at a time; changed pulses go first, and every output that was told
// one is told again each refresh interval, as an autopilot that was restarted knows nothing of it.
//
// Crash: the autopilot keeps the last pulse for as long as it runs.
class MavlinkServos {
 public:
  static constexpr hal::Duration kRefresh = std::chrono::milliseconds(500);

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
  void finish(std::optional<hal::Error> failure);

  hal::Duration timeout_;
  int max_tries_;
  std::array<MavlinkServo, 16> outputs_;
  std::array<hal::Instant, 16> told_at_{};
  bool link_up_ = false;
  MavlinkServo* pending_ = nullptr;
  std::uint16_t pending_us_ = 0;
  int tries_ = 0;
  hal::Instant next_try_;
  std::size_t turn_ = 0;  // where the search for the next one begins: nobody starves
};

}  // namespace forager::flight
