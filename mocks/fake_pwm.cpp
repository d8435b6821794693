#include "mocks/fake_pwm.hpp"

#include <fmt/format.h>

#include <utility>

namespace forager::mocks {

hal::Result<> FakePwmChannel::admit(std::string_view operation) {
  if (next_error_) return hal::fail(*std::exchange(next_error_, std::nullopt));
  if (disconnected_)
    return hal::fail(hal::ErrorCode::disconnected, name_, std::string(operation), "the cable is out");
  return {};
}

void FakePwmChannel::become(std::optional<hal::Duration> pulse) {
  ++calls_;
  if (pulse == pulse_) return;
  pulse_ = pulse;
  changes_.push_back({group_->now_, pulse});
  if (group_->journal_ != nullptr)
    group_->journal_->note(group_->now_, name_,
                           pulse ? fmt::format("pulse {} ns", pulse->count()) : "released");
}

hal::Result<> FakePwmChannel::do_set_pulse(hal::Duration length) {
  if (length < hal::Duration::zero() || length > group_->period_)
    return hal::fail(
        hal::ErrorCode::invalid_argument, name_, "set pulse",
        fmt::format("{} ns is not from 0 to the period, {} ns", length.count(), group_->period_.count()));
  FORAGER_TRY(admit("set pulse"));
  become(length);
  return {};
}

hal::Result<> FakePwmChannel::do_release() {
  FORAGER_TRY(admit("release"));
  become(std::nullopt);
  return {};
}

FakePwmGroup::FakePwmGroup(std::string name, std::size_t channels, hal::Duration period,
                           hal::Journal* journal)
    : name_(std::move(name)), period_(period), journal_(journal) {
  for (std::size_t index = 0; index < channels; ++index)
    channels_.emplace_back(*this, fmt::format("{} channel {}", name_, index));
}

hal::Result<> FakePwmGroup::do_set_period(hal::Duration period) {
  const auto refuse = [&](std::string why) {
    return hal::fail(hal::ErrorCode::invalid_argument, name_, "set period", std::move(why));
  };
  if (period <= hal::Duration::zero()) return refuse("a period is longer than nothing");
  for (const FakePwmChannel& channel : channels_)
    if (channel.pulse_ && *channel.pulse_ > period)
      return refuse(fmt::format("{} has a pulse of {} ns, longer than {} ns", channel.name_,
                                channel.pulse_->count(), period.count()));
  period_ = period;
  return {};
}

}  // namespace forager::mocks
