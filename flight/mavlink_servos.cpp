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
  if (!servos_->link_up_)
    return hal::fail(hal::ErrorCode::disconnected, name_, "set pulse", "the autopilot is not heard",
                     "Check its power and the link");
  wanted_us_ = us;
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
      if (outputs_[index].wanted_us_ && wanted(outputs_[index], index)) {
        turn_ = index + 1;
        return &outputs_[index];
      }
    }
    return nullptr;
  };
  MavlinkServo* const changed =
      search([](const MavlinkServo& servo, std::size_t) { return servo.wanted_us_ != servo.acked_us_; });
  if (changed != nullptr) return changed;
  return search([&](const MavlinkServo&, std::size_t index) { return now - told_at_[index] >= kRefresh; });
}

std::optional<mavlink::CommandLong> MavlinkServos::due(hal::Instant now) {
  if (!link_up_) return std::nullopt;
  if (pending_ != nullptr && now < next_try_) return std::nullopt;
  if (pending_ != nullptr && tries_ >= max_tries_)
    finish(hal::Error{hal::ErrorCode::timeout, std::string(pending_->name_), "set pulse",
                      fmt::format("not acknowledged in {} tries", max_tries_), ""});
  if (pending_ == nullptr) {
    pending_ = next(now);
    tries_ = 0;
  }
  if (pending_ == nullptr) return std::nullopt;
  pending_us_ = *pending_->wanted_us_;  // the newest, at every try
  told_at_[pending_->output_ - 1U] = now;
  next_try_ = now + timeout_;
  mavlink::CommandLong command;
  command.command = mavlink::command::kDoSetServo;
  command.confirmation = static_cast<std::uint8_t>(tries_++);
  command.param1 = static_cast<float>(pending_->output_);
  command.param2 = static_cast<float>(pending_us_);
  return command;
}

void MavlinkServos::take(const mavlink::CommandAck& ack) {
  if (ack.command != mavlink::command::kDoSetServo || pending_ == nullptr) return;
  if (ack.result == mavlink::result::kAccepted) {
    pending_->acked_us_ = pending_us_;
    return finish(std::nullopt);
  }
  if (ack.result == mavlink::result::kTemporarilyRejected || ack.result == mavlink::result::kInProgress)
    return;
  finish(hal::Error{hal::ErrorCode::refused, pending_->name_, "set pulse",
                    fmt::format("the autopilot refused (result {})", ack.result),
                    fmt::format("Set SERVO{}_FUNCTION to 0", pending_->output_)});
}

// A failed pulse is not tried again by itself but at the next set or refresh, so that others get their turn.
void MavlinkServos::finish(std::optional<hal::Error> failure) {
  if (failure) pending_->acked_us_ = pending_us_;
  pending_->failure_ = std::move(failure);
  pending_ = nullptr;
}

void MavlinkServos::forget() {
  pending_ = nullptr;
  for (MavlinkServo& servo : outputs_) servo.acked_us_.reset();
}

}  // namespace forager::flight
