#pragma once

#include <optional>
#include <string>

#include "hal/pwm.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// A duration that an operation of a PWM output ended with; nothing: no field, released.
inline hal::Result<std::optional<hal::Duration>> length_in(const hal::Result<hal::Fields>& fields,
                                                           std::string_view device,
                                                           std::string_view operation) {
  if (!fields) return hal::fail(fields.error());
  if (fields->empty()) return std::optional<hal::Duration>{};
  const auto length = hal::integer_in(fields->front());
  if (!length) return Replay::broken(device, operation);
  return std::optional(hal::Duration(*length));
}

// PWM outputs as mocks/recording_pwm.hpp noted them; `name` is that of the recorded one.

class ReplayPwmChannel final : public hal::PwmChannel {
 public:
  ReplayPwmChannel(std::string name, Replay& replay)
      : name_(std::move(name)),
        replay_(&replay),
        pulse_(length_in(replay.held(name_, "<pulse"), name_, "<pulse").value_or(std::nullopt)) {}

 private:
  hal::Result<> take(std::string_view operation, const hal::Fields& asked) {
    const auto length = length_in(replay_->call(name_, operation, asked), name_, operation);
    if (!length) return hal::fail(length.error());
    pulse_ = *length;
    return {};
  }
  hal::Result<> do_set_pulse(hal::Duration length) override {
    return take("set_pulse", {hal::field(length)});
  }
  hal::Result<> do_release() override { return take("release", {}); }
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override { return pulse_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  Replay* replay_;
  std::optional<hal::Duration> pulse_;
};

class ReplayPwmGroup final : public hal::PwmGroup {
 public:
  ReplayPwmGroup(std::string name, Replay& replay)
      : name_(std::move(name)),
        replay_(&replay),
        period_(length_in(replay.held(name_, "<period"), name_, "<period")
                    .value_or(std::nullopt)
                    .value_or(hal::Duration(1))) {}

 private:
  hal::Result<> do_set_period(hal::Duration period) override {
    const auto got = length_in(replay_->call(name_, "set_period", {hal::field(period)}), name_, "set_period");
    if (!got) return hal::fail(got.error());
    if (!*got) return Replay::broken(name_, "set_period");
    period_ = **got;
    return {};
  }
  [[nodiscard]] hal::Duration do_period() const override { return period_; }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  std::string name_;
  Replay* replay_;
  hal::Duration period_;
};

}  // namespace forager::mocks
