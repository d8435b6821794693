#include "hal/linux/pulse_engine.hpp"

#include <fmt/format.h>

#include <utility>

namespace forager::hal {

EngineChannel::EngineChannel(PulseEngine& engine, DigitalOut& line, std::optional<Duration> stale_pulse)
    : engine_(&engine),
      line_(&line),
      name_(fmt::format("software pwm on {}", line.name())),
      stale_pulse_(stale_pulse) {}

Result<> EngineChannel::last_fault(std::string_view operation) const {
  const int code = fault_.load(std::memory_order_relaxed);
  if (code < 0) return {};
  return fail(static_cast<ErrorCode>(code), name_, std::string(operation),
              fmt::format("the line fails: {}", to_string(static_cast<ErrorCode>(code))));
}

Result<> EngineChannel::do_set_pulse(Duration length) {
  if (length < Duration::zero() || length > engine_->period())
    return fail(
        ErrorCode::invalid_argument, name_, "set pulse",
        fmt::format("{} ns is not from 0 to the period, {} ns", length.count(), engine_->period().count()));
  FORAGER_TRY(last_fault("set pulse"));
  wanted_ns_.store(length.count(), std::memory_order_relaxed);
  return {};
}

Result<> EngineChannel::do_release() {
  wanted_ns_.store(kReleased, std::memory_order_relaxed);
  return last_fault("release");
}

std::optional<Duration> EngineChannel::do_pulse() const {
  const std::int64_t ns = wanted_ns_.load(std::memory_order_relaxed);
  return ns == kReleased ? std::nullopt : std::optional(Duration(ns));
}

PulseEngine::PulseEngine(std::string name, const std::vector<Line>& lines, Duration period,
                         Duration stale_after)
    : name_(std::move(name)), period_ns_(period.count()), stale_after_(stale_after) {
  for (const Line& line : lines) channels_.emplace_back(*this, *line.line, line.stale_pulse);
}

PulseEngine::~PulseEngine() { all_inactive(); }

Result<> PulseEngine::do_set_period(Duration period) {
  if (period <= Duration::zero())
    return fail(ErrorCode::invalid_argument, name_, "set period", "a period is longer than nothing");
  for (const EngineChannel& channel : channels_)
    if (const auto pulse = channel.pulse(); pulse && *pulse > period)
      return fail(ErrorCode::invalid_argument, name_, "set period",
                  fmt::format("{} makes a pulse longer than {} ns", channel.name(), period.count()));
  period_ns_.store(period.count(), std::memory_order_relaxed);
  return {};
}

bool PulseEngine::put(EngineChannel& channel, bool active) {
  const auto told = channel.line_->set(active);
  channel.fault_.store(told ? -1 : static_cast<int>(told.error().code), std::memory_order_relaxed);
  return told.has_value();
}

std::int64_t PulseEngine::pulse_for(const EngineChannel& channel, Instant now) const {
  const std::int64_t wanted = channel.wanted_ns_.load(std::memory_order_relaxed);
  const bool stale = stale_after_ > Duration::zero() &&
                     now - Instant(Duration(fed_ns_.load(std::memory_order_relaxed))) > stale_after_;
  if (wanted == EngineChannel::kReleased || !stale) return wanted;
  return channel.stale_pulse_ ? channel.stale_pulse_->count() : EngineChannel::kReleased;
}

void PulseEngine::begin_pulse(EngineChannel& channel, Clock& clock) {
  const bool was_high = channel.high_;
  if (was_high && channel.end_) return;  // so late that the last one still is on: it ends first
  if (!was_high) channel.high_ = put(channel, true);
  channel.rose_ = clock.now();
  channel.end_.reset();
  // A pulse as long as the period does not end: the next one would begin at the same moment.
  if (Duration(channel.pulse_ns_) < do_period()) channel.end_ = channel.rose_ + Duration(channel.pulse_ns_);
}

bool PulseEngine::left_out(Instant planned, Instant now) {
  const Duration period = do_period();
  if (now - planned <= period / 4) return false;
  const auto missed = (now - planned) / period + 1;
  missed_.fetch_add(static_cast<std::uint64_t>(missed), std::memory_order_relaxed);
  next_period_ = planned + missed * period;
  return true;
}

void PulseEngine::begin_period(Clock& clock) {
  const Instant planned = *next_period_;
  const Instant now = clock.now();
  if (left_out(planned, now)) return;
  next_period_ = planned + do_period();
  bool measured = false;
  for (EngineChannel& channel : channels_) {
    channel.pulse_ns_ = pulse_for(channel, now);
    if (channel.pulse_ns_ > 0) {
      begin_pulse(channel, clock);
      if (channel.high_ && !std::exchange(measured, true)) start_jitter_.add(channel.rose_ - planned);
    } else if (channel.high_ || channel.fault_.load(std::memory_order_relaxed) >= 0) {
      channel.high_ = !put(channel, false);  // it was on into this period, or may work again
      channel.end_.reset();
    }
  }
}

void PulseEngine::end_pulse(EngineChannel& channel, Clock& clock) {
  constexpr Duration kAgain = std::chrono::milliseconds(1);
  const Instant planned = *channel.end_;
  channel.high_ = !put(channel, false);
  const Instant now = clock.now();
  if (channel.high_) {
    channel.end_ = now + kAgain;
    return;
  }
  channel.end_.reset();
  pulse_jitter_.add(now - planned);
}

void PulseEngine::step(Clock& clock) {
  if (!next_period_) next_period_ = clock.now();
  EngineChannel* first = nullptr;
  Instant when = *next_period_;
  for (EngineChannel& channel : channels_) {
    if (!channel.high_ || !channel.end_ || *channel.end_ > when) continue;
    when = *channel.end_;
    first = &channel;
  }
  clock.sleep_until(when);
  if (first != nullptr)
    end_pulse(*first, clock);
  else
    begin_period(clock);
}

void PulseEngine::all_inactive() {
  for (EngineChannel& channel : channels_) channel.high_ = !put(channel, false);
}

}  // namespace forager::hal
