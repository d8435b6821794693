#include "servo/pca9685.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace forager::servo {

using namespace pca9685;

namespace {

constexpr hal::Duration kWake = std::chrono::microseconds(kOscillatorWakeUs);

}  // namespace

hal::Result<> Pca9685Channel::do_set_pulse(hal::Duration length) {
  if (length < hal::Duration::zero() || length > chip_->period())
    return hal::fail(
        hal::ErrorCode::invalid_argument, name_, "set pulse",
        fmt::format("{} ns is not from 0 to the period, {} ns", length.count(), chip_->period().count()));
  return chip_->become(*this, length);
}

hal::Result<> Pca9685Channel::do_release() { return chip_->become(*this, std::nullopt); }

std::optional<hal::Duration> Pca9685Channel::do_pulse() const {
  if (!wanted_) return std::nullopt;
  const double tick_ns = static_cast<double>(chip_->period().count()) / kSteps;
  return hal::Duration(std::llround(static_cast<double>(chip_->ticks(*wanted_)) * tick_ns));
}

Pca9685::Pca9685(hal::I2c& bus, hal::DigitalOut* enable, hal::Journal& journal, const Pca9685Config& config)
    : bus_(&bus),
      enable_(enable),
      journal_(&journal),
      config_(config),
      name_(fmt::format("pca9685 0x{:02x} on {}", config.address, bus.name())) {
  for (std::uint8_t i = 0; i < kChannels; ++i) {
    channels_[i].chip_ = this;
    channels_[i].index_ = i;
    channels_[i].name_ = fmt::format("pca9685 0x{:02x} channel {}", config.address, i);
  }
  if (const auto prescale = prescale_for(config.period)) prescale_ = *prescale;
}

hal::Failure Pca9685::refuse(hal::ErrorCode code, std::string_view operation, std::string why) const {
  return hal::fail(code, name_, std::string(operation), std::move(why));
}

// Data sheet section 7.3.5: prescale = round(oscillator / (4096 * rate)) - 1.
hal::Result<std::uint8_t> Pca9685::prescale_for(hal::Duration period) const {
  if (!(config_.oscillator_hz > 0.0) || !std::isfinite(config_.oscillator_hz))
    return refuse(hal::ErrorCode::invalid_argument, "open", "the oscillator's frequency is not positive");
  if (period <= hal::Duration::zero())
    return refuse(hal::ErrorCode::invalid_argument, "set period", "a period is longer than nothing");
  const double divided = std::round(config_.oscillator_hz * hal::to_seconds(period) / kSteps) - 1.0;
  if (!(divided >= kPreScaleMin && divided <= 255.0))
    return refuse(hal::ErrorCode::unsupported, "set period",
                  fmt::format("{} us needs a prescaler of {:.0f}; the chip has 3 to 255",
                              period / std::chrono::microseconds(1), divided));
  return static_cast<std::uint8_t>(divided);
}

hal::Duration Pca9685::do_period() const {
  return hal::Duration(std::llround((prescale_ + 1.0) * kSteps / config_.oscillator_hz * 1e9));
}

long Pca9685::ticks(hal::Duration pulse) const {
  return std::lround(static_cast<double>(pulse.count()) * kSteps / static_cast<double>(period().count()));
}

hal::Result<> Pca9685::write(std::uint8_t reg, std::uint8_t value) {
  const std::array bytes{std::byte{reg}, std::byte{value}};
  return bus_->write(config_.address, bytes);
}

hal::Result<std::uint8_t> Pca9685::read(std::uint8_t reg) {
  const std::array bytes{std::byte{reg}};
  std::array<std::byte, 1> answer{};
  FORAGER_TRY(bus_->write_read(config_.address, bytes, answer));
  return std::to_integer<std::uint8_t>(answer[0]);
}

hal::Result<> Pca9685::open(hal::Instant now) {
  now_ = now;
  state_ = State::closed;
  const auto prescale = prescale_for(config_.period);
  if (!prescale) return hal::fail(prescale.error());
  if (enable_ != nullptr) FORAGER_TRY(enable_->set(false));
  const auto mode1 = read(kMode1);
  if (!mode1) return hal::fail(mode1.error());
  FORAGER_TRY(
      write(kMode1, kAutoIncrement | kSleep));  // first of all: bursts need it, PRE_SCALE needs the sleep
  constexpr std::array kAllOff{std::byte{kAllLed}, std::byte{0}, std::byte{0}, std::byte{0},
                               std::byte{kFull}};
  FORAGER_TRY(bus_->write(config_.address, kAllOff));
  FORAGER_TRY(write(kMode2, mode2_wanted()));
  FORAGER_TRY(write(kPreScale, *prescale));
  const auto kept = read(kPreScale);
  if (!kept) return hal::fail(kept.error());
  if (*kept != *prescale)
    return refuse(
        hal::ErrorCode::protocol, "open",
        fmt::format("PRE_SCALE reads {} after {} was written: this is no PCA9685", *kept, *prescale));
  prescale_ = *prescale;
  was_open_ = true;
  for (Pca9685Channel& channel : channels_) channel.pending_ = channel.wanted_.has_value();
  FORAGER_TRY(send_pending());
  return wake();
}

hal::Result<> Pca9685::adopt(hal::Instant now) {
  const auto wanted = prescale_for(config_.period);
  if (!wanted) return hal::fail(wanted.error());
  const auto mode1 = read(kMode1);
  const auto mode2 = mode1 ? read(kMode2) : mode1;
  const auto prescale = mode2 ? read(kPreScale) : mode2;
  if (!prescale) return hal::fail(prescale.error());
  if (!runs(*mode1) || *mode2 != mode2_wanted() || *prescale != *wanted) return open(now);
  now_ = now;
  prescale_ = *prescale;
  was_open_ = true;
  state_ = State::running;
  next_check_ = now + config_.check_interval;
  return enable_ != nullptr ? enable_->set(true) : hal::Result<>{};
}

std::uint8_t Pca9685::mode2_wanted() const {
  return static_cast<std::uint8_t>(kTotemPole | (config_.inverted ? kInvert : 0));
}

bool Pca9685::runs(std::uint8_t mode1) { return (mode1 & (kSleep | kAutoIncrement)) == kAutoIncrement; }

hal::Result<> Pca9685::wake() {
  FORAGER_TRY(write(kMode1, kAutoIncrement));
  state_ = State::waking;
  woken_at_.reset();
  return {};
}

hal::Result<> Pca9685::update(hal::Instant now) {
  now_ = now;
  if (state_ == State::waking) {
    if (!woken_at_) woken_at_ = now;
    if (now - *woken_at_ < kWake) return {};
    auto woken = finish_waking();
    next_check_ = now + config_.check_interval;
    if (!woken) state_ = State::closed;  // or pulses would be taken that nobody makes
    return woken;
  }
  if (!was_open_ || config_.check_interval <= hal::Duration::zero() || now < next_check_) return {};
  next_check_ = now + config_.check_interval;
  return state_ == State::closed ? open(now) : check(now);
}

hal::Result<> Pca9685::finish_waking() {
  const auto mode1 = read(kMode1);
  if (!mode1) return hal::fail(mode1.error());
  FORAGER_TRY(send_pending());
  // Outputs stopped by the sleep go on only after this (data sheet section 7.3.1.1).
  if ((*mode1 & kRestart) != 0) FORAGER_TRY(write(kMode1, kAutoIncrement | kRestart));
  if (enable_ != nullptr) FORAGER_TRY(enable_->set(true));
  state_ = State::running;
  journal_->note(now_, "pca9685",
                 fmt::format("0x{:02x}: running at {:.2f} Hz", config_.address,
                             1e9 / static_cast<double>(period().count())));
  return {};
}

// A brown-out leaves MODE1 and PRE_SCALE at their reset values: asleep, no auto-increment.
hal::Result<> Pca9685::check(hal::Instant now) {
  const auto mode1 = read(kMode1);
  const auto prescale = mode1 ? read(kPreScale) : mode1;
  if (!prescale) {
    state_ = State::closed;
    return hal::fail(prescale.error());
  }
  if (runs(*mode1) && *prescale == prescale_) return send_pending();
  ++recoveries_;
  journal_->note(
      now, "pca9685",
      fmt::format("0x{:02x}: was reset (MODE1 0x{:02x}); making it anew", config_.address, *mode1));
  return open(now);
}

// The newest wish is kept whatever becomes of it: a chip that comes back must not go on with an older one.
hal::Result<> Pca9685::become(Pca9685Channel& channel, std::optional<hal::Duration> pulse) {
  if (was_open_) channel.wanted_ = pulse;
  if (state_ == State::closed)
    return hal::fail(hal::ErrorCode::invalid_state, channel.name_, "set pulse",
                     "the chip is not open, or was lost");
  channel.pending_ = true;
  if (state_ == State::waking) return {};
  auto sent = send(channel);
  channel.pending_ = !sent;
  return sent;
}

hal::Result<> Pca9685::send_pending() {
  for (Pca9685Channel& channel : channels_) {
    if (!channel.pending_) continue;
    FORAGER_TRY(send(channel));
    channel.pending_ = false;
  }
  return {};
}

hal::Result<> Pca9685::send(const Pca9685Channel& channel) {
  const long off = channel.wanted_ ? ticks(*channel.wanted_) : 0;
  const auto low = [](long value) { return static_cast<std::byte>(value & 0xFF); };
  const auto high = [](long value) { return static_cast<std::byte>((value >> 8) & 0x0F); };
  std::array<std::byte, 5> burst{static_cast<std::byte>(kLed0 + 4 * channel.index_), std::byte{0},
                                 std::byte{0}, low(off), high(off)};
  if (off == 0) burst[4] = std::byte{kFull};  // full off wins over everything
  if (off >= kSteps) burst = {burst[0], std::byte{0}, std::byte{kFull}, std::byte{0}, std::byte{0}};
  return bus_->write(config_.address, burst);
}

hal::Result<> Pca9685::do_set_period(hal::Duration period) {
  const auto prescale = prescale_for(period);
  if (!prescale) return hal::fail(prescale.error());
  const double period_ns = (*prescale + 1.0) * kSteps / config_.oscillator_hz * 1e9;
  for (const Pca9685Channel& channel : channels_)
    if (channel.wanted_ && static_cast<double>(channel.wanted_->count()) > period_ns)
      return refuse(hal::ErrorCode::invalid_argument, "set period",
                    fmt::format("channel {} has a pulse of {} us, longer than {:.0f} us", channel.index_,
                                *channel.wanted_ / std::chrono::microseconds(1), period_ns / 1e3));
  config_.period = period;
  if (state_ == State::closed) {
    prescale_ = *prescale;
    return {};
  }
  FORAGER_TRY(write(kMode1, kAutoIncrement | kSleep));
  FORAGER_TRY(write(kPreScale, *prescale));
  prescale_ = *prescale;
  for (Pca9685Channel& channel : channels_) channel.pending_ |= channel.wanted_.has_value();
  FORAGER_TRY(send_pending());
  return wake();
}

void Pca9685::disable() noexcept {
  if (enable_ != nullptr && enable_->set(false)) return;
  for (Pca9685Channel& channel : channels_) static_cast<void>(channel.release());
}

}  // namespace forager::servo
