#include "flight/mavlink_servos.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flight/mavlink/mavlink_wire.hpp"

namespace forager::flight {
namespace {

constexpr hal::Duration kLongest = std::chrono::microseconds(3000);
// A servo is not worth the second a change of mode may take.
constexpr hal::Duration kPatience = std::chrono::milliseconds(200);

}  // namespace

hal::Result<> MavlinkServo::do_set_pulse(hal::Duration length) {
  if (length < hal::Duration::zero() || length > kLongest)
    return hal::fail(hal::ErrorCode::invalid_argument, name_, "set pulse",
                     fmt::format("{} ns is not from 0 to 3 ms", length.count()));
  return want(static_cast<std::uint16_t>((length.count() + 500) / 1000));
}

hal::Result<> MavlinkServo::do_release() {
  return want(0);  // ArduPilot makes no pulses for 0
}

hal::Result<> MavlinkServo::want(std::uint16_t us) {
  wanted_us_ = us;
  if (!servos_->link_up_)
    return hal::fail(hal::ErrorCode::disconnected, name_, "set pulse", "the autopilot is not heard",
                     "Check its power and the link");
  if (failure_) return hal::fail(*std::exchange(failure_, std::nullopt));
  return {};
}

std::optional<hal::Duration> MavlinkServo::do_pulse() const {
  if (wanted_us_.value_or(0) == 0) return std::nullopt;
  return std::chrono::microseconds(*wanted_us_);
}

MavlinkServos::MavlinkServos(const MavlinkConfig& config)
    : timeout_(std::min(config.command_timeout, kPatience)), max_tries_(config.command_tries) {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    outputs_[i].servos_ = this;
    outputs_[i].output_ = static_cast<std::uint8_t>(i + 1);
    outputs_[i].name_ = fmt::format("autopilot output {}", i + 1);
  }
}

MavlinkServo* MavlinkServos::next(hal::Instant now) {
  const auto search = [&](auto wanted) -> MavlinkServo* {
    for (std::size_t i = 0; i < outputs_.size(); ++i) {
      const std::size_t index = (turn_ + i) % outputs_.size();
      MavlinkServo& servo = outputs_[index];
      const bool waits = servo.tries_ > 0 && now < servo.next_try_;
      if (servo.wanted_us_ && !waits && wanted(servo, index)) {
        turn_ = index + 1;
        return &servo;
      }
    }
    return nullptr;
  };
  MavlinkServo* const changed = search([](const MavlinkServo& servo, std::size_t) {
    return servo.wanted_us_ != servo.acked_us_ || servo.tries_ > 0;
  });
  if (changed != nullptr) return changed;
  return search([&](const MavlinkServo&, std::size_t index) { return now - told_at_[index] >= kRefresh; });
}

void MavlinkServos::give_up(hal::Instant now) {
  for (MavlinkServo& servo : outputs_)
    if (servo.tries_ >= max_tries_ && now >= servo.next_try_)
      finish(servo, hal::Error{hal::ErrorCode::timeout, std::string(servo.name_), "set pulse",
                               fmt::format("not acknowledged in {} tries", max_tries_), ""});
}

std::optional<mavlink::CommandLong> MavlinkServos::due(hal::Instant now) {
  if (!link_up_ || (turn_ends_ && now < *turn_ends_)) return std::nullopt;
  give_up(now);
  MavlinkServo* const servo = next(now);
  if (servo == nullptr) return std::nullopt;
  servo->sent_us_ = *servo->wanted_us_;  // the newest, at every try
  servo->sent_as_ = ++sent_;
  servo->next_try_ = now + timeout_;
  told_at_[servo->output_ - 1U] = now;
  turn_ends_ = now + std::min(timeout_, kTurn);
  mavlink::CommandLong command;
  command.command = mavlink::command::kDoSetServo;
  command.confirmation = static_cast<std::uint8_t>(servo->tries_++);
  command.param1 = static_cast<float>(servo->output_);
  command.param2 = static_cast<float>(servo->sent_us_);
  return command;
}

MavlinkServo* MavlinkServos::newest_unanswered() {
  const auto older = [](const MavlinkServo& a, const MavlinkServo& b) {
    return (a.tries_ > 0 ? a.sent_as_ : 0) < (b.tries_ > 0 ? b.sent_as_ : 0);
  };
  MavlinkServo& newest = *std::ranges::max_element(outputs_, older);
  return newest.tries_ > 0 ? &newest : nullptr;
}

void MavlinkServos::take(const mavlink::CommandAck& ack) {
  MavlinkServo* const servo = newest_unanswered();
  if (ack.command != mavlink::command::kDoSetServo || servo == nullptr) return;
  if (ack.result == mavlink::result::kAccepted) return finish(*servo, std::nullopt);
  const auto unanswered = std::ranges::count_if(outputs_, [](const MavlinkServo& s) { return s.tries_ > 0; });
  if (ack.result == mavlink::result::kTemporarilyRejected || ack.result == mavlink::result::kInProgress ||
      unanswered > 1)
    return;
  finish(*servo, hal::Error{hal::ErrorCode::refused, servo->name_, "set pulse",
                            fmt::format("the autopilot refused (result {})", ack.result),
                            fmt::format("Set SERVO{}_FUNCTION to 0", servo->output_)});
}

// A failed pulse is not tried again by itself but at the next set or refresh, so that others get their turn.
void MavlinkServos::finish(MavlinkServo& servo, std::optional<hal::Error> failure) {
  servo.acked_us_ = servo.sent_us_;
  servo.failure_ = std::move(failure);
  servo.tries_ = 0;
  if (servo.sent_as_ == sent_) turn_ends_.reset();
}

void MavlinkServos::forget() {
  turn_ends_.reset();
  for (MavlinkServo& servo : outputs_) {
    servo.acked_us_.reset();
    servo.tries_ = 0;
  }
}

}  // namespace forager::flight
