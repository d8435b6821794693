#include "flight/esc_bank.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "esc";
constexpr double kLongestStep_s = 0.05;  // a pause counts as this much of a ramp

double us(hal::Duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

}  // namespace

std::string_view to_string(EscState state) {
  switch (state) {
    case EscState::stopped:
      return "stopped";
    case EscState::arming:
      return "arming";
    case EscState::armed:
      return "armed";
    case EscState::calibrating:
      return "calibrating";
    case EscState::faulted:
      return "faulted";
    case EscState::halted:
      return "halted";
  }
  return "?";
}

hal::Result<std::unique_ptr<EscBank>> EscBank::create(MotorAuthority motors, const hal::PwmGroup& group,
                                                      std::vector<EscLine> lines, hal::DigitalOut* power,
                                                      hal::Journal& journal, const EscBankConfig& config,
                                                      hal::Instant now) {
  constexpr const char* kOpen = "take over the lines";
  FORAGER_TRY(validate(config, group.period()));
  if (!motors.valid())
    return hal::fail(hal::ErrorCode::invalid_state, "ESCs", kOpen, "nobody gave them the motors");
  if (lines.empty() || lines.size() > kMost)
    return hal::fail(hal::ErrorCode::invalid_argument, "ESCs", kOpen,
                     fmt::format("{} lines; 1 to {} are possible", lines.size(), kMost));
  for (const EscLine& line : lines)
    if (line.channel == nullptr)
      return hal::fail(hal::ErrorCode::invalid_argument, "ESC " + line.name, kOpen, "it has no output");
  std::unique_ptr<EscBank> bank(
      new EscBank(std::move(motors), group.period(), std::move(lines), power, journal, config, now));
  FORAGER_TRY(bank->begin(now));
  return bank;
}

EscBank::EscBank(MotorAuthority motors, hal::Duration period, std::vector<EscLine> lines,
                 hal::DigitalOut* power, hal::Journal& journal, const EscBankConfig& config, hal::Instant now)
    : authority_(std::move(motors)),
      power_(power),
      journal_(&journal),
      config_(config),
      arming_(config.arming, period, now),
      calibration_(config.calibration, power != nullptr),
      command_until_(now),
      last_(now) {
  motors_.reserve(lines.size());
  for (EscLine& line : lines) motors_.push_back({.line = std::move(line), .sent = std::nullopt});
}

EscBank::~EscBank() { halt(); }

hal::Result<> EscBank::begin(hal::Instant now) {
  FORAGER_TRY(drive(now));
  // What the hardware makes of the stop pulse is what the ESC will wake to.
  const hal::Duration most = encode_pulse(config_.pulses.idle, config_.pulses.protocol);
  for (const Motor& motor : motors_) {
    const std::optional<hal::Duration> made = motor.line.channel->pulse();
    if (made && *made > most)
      return hal::fail(hal::ErrorCode::invalid_argument, "ESC " + motor.line.name, "take over the lines",
                       fmt::format("{} makes {:.1f} us of the stop pulse, above idle",
                                   motor.line.channel->name(), us(*made)),
                       "use an output with finer steps");
  }
  return {};
}

hal::Failure EscBank::not_now(std::string_view operation) const {
  return hal::fail(hal::ErrorCode::invalid_state, "ESCs", std::string(operation),
                   fmt::format("they are {} ({})", to_string(state_), reason_));
}

hal::Result<> EscBank::arm(const PropsOff& /*word*/, hal::Instant now) {
  if (state_ != EscState::stopped) return not_now("arm");
  arming_.begin();
  enter(EscState::arming, "asked to arm, propellers off", now);
  return {};
}

hal::Result<> EscBank::calibrate(const PropsOff& /*word*/, hal::Instant now) {
  if (state_ != EscState::stopped) return not_now("calibrate");
  calibration_.begin(now);
  enter(EscState::calibrating, "asked to calibrate, propellers off", now);
  return {};
}

void EscBank::disarm(std::string_view why, hal::Instant now) {
  if (state_ != EscState::arming && state_ != EscState::armed && state_ != EscState::calibrating) return;
  enter(EscState::stopped, why, now);
  if (auto driven = drive(now); !driven) enter(EscState::faulted, hal::describe(driven.error()), now);
}

hal::Result<> EscBank::command(std::span<const double> throttle, hal::Instant now) {
  // Whoever comes too late finds the motors stopped, even if nobody has looked in between.
  if (state_ == EscState::armed && now >= command_until_) disarm("no command in time", now);
  if (state_ != EscState::armed) return not_now("command throttle");
  if (throttle.size() != motors_.size())
    return hal::fail(hal::ErrorCode::invalid_argument, "ESCs", "command throttle",
                     fmt::format("{} values for {} motors", throttle.size(), motors_.size()));
  for (const double value : throttle)
    if (!(value >= 0.0 && value <= 1.0))
      return hal::fail(hal::ErrorCode::invalid_argument, "ESCs", "command throttle",
                       fmt::format("{} is not in 0..1", value));
  for (std::size_t i = 0; i < motors_.size(); ++i)
    motors_[i].wanted = std::min(throttle[i], config_.most_throttle);
  command_until_ = now + config_.command_max_age;
  return {};
}

void EscBank::update(hal::Instant now) {
  advance(now);
  if (state_ == EscState::armed) ramp(std::clamp(hal::to_seconds(now - last_), 0.0, kLongestStep_s));
  last_ = now;
  if (auto driven = drive(now); !driven && state_ != EscState::faulted) {
    enter(EscState::faulted, hal::describe(driven.error()), now);
    (void)drive(now);  // the others stop in the same update
  }
}

void EscBank::advance(hal::Instant now) {
  if (state_ == EscState::arming) {
    arming_.update(now);
    if (arming_.armed()) {
      command_until_ = now + config_.command_max_age;
      enter(EscState::armed, "stop pulses counted", now);
    }
  } else if (state_ == EscState::armed && now >= command_until_) {
    enter(EscState::stopped, fmt::format("no command for {:.0f} ms", us(config_.command_max_age) / 1e3), now);
  } else if (state_ == EscState::calibrating) {
    const EscCalibration::State before = calibration_.state();
    calibration_.update(now);
    if (calibration_.state() != before)
      journal_->note(now, kSource, fmt::format("calibration: {}", to_string(calibration_.state())));
    if (!calibration_.active()) enter(EscState::stopped, "calibration over", now);
  }
}

void EscBank::ramp(double dt_s) {
  for (Motor& motor : motors_) {
    const double up = motor.throttle + config_.rise_per_s * dt_s;
    const double down = motor.throttle - config_.fall_per_s * dt_s;
    motor.throttle = std::clamp(motor.wanted, std::max(down, 0.0), std::min(up, 1.0));
  }
}

void EscBank::enter(EscState state, std::string_view why, hal::Instant now) {
  journal_->note(now, kSource, fmt::format("{} -> {}: {}", to_string(state_), to_string(state), why));
  if (state != EscState::arming && state != EscState::armed) arming_.reset(now);
  if (state != EscState::calibrating && calibration_.active()) calibration_.abort();
  for (Motor& motor : motors_) motor.wanted = motor.throttle = 0.0;
  state_ = state;
  reason_ = why;
}

hal::Duration EscBank::wanted_pulse(const Motor& motor) const {
  if (state_ == EscState::armed) return pulse_of(motor.throttle, config_.pulses);
  if (state_ == EscState::calibrating && calibration_.line_high()) return config_.pulses.high;
  return config_.pulses.stop;
}

bool EscBank::wanted_power() const {
  if (state_ == EscState::arming || state_ == EscState::armed) return arming_.power();
  return state_ == EscState::calibrating && calibration_.power();
}

hal::Result<> EscBank::drive(hal::Instant now) {
  // Every line is tried, whatever happens to the others; the first error is told.
  hal::Result<> result;
  for (Motor& motor : motors_)
    if (auto driven = drive_line(motor, now); !driven && result) result = std::move(driven);
  if (auto driven = drive_power(now); !driven && result) result = std::move(driven);
  return result;
}

hal::Result<> EscBank::drive_line(Motor& motor, hal::Instant now) {
  const hal::Duration wanted = wanted_pulse(motor);
  if (motor.sent == wanted) return {};
  motor.sent.reset();
  FORAGER_TRY(motor.line.channel->set_pulse(encode_pulse(wanted, config_.pulses.protocol)));
  motor.sent = wanted;
  journal_->note(now, kSource, fmt::format("{} {:.1f} us", motor.line.name, us(wanted)));
  return {};
}

hal::Result<> EscBank::drive_power(hal::Instant now) {
  const bool wanted = wanted_power();
  if (power_ == nullptr) {
    powered_ = true;  // a person's business: taken for on, the careful way
    return {};
  }
  if (power_known_ && powered_ == wanted) return {};
  power_known_ = false;
  FORAGER_TRY(power_->set(wanted));
  powered_ = wanted;
  power_known_ = true;
  journal_->note(now, kSource, wanted ? "power on" : "power off");
  return {};
}

void EscBank::halt() noexcept {
  try {
    if (state_ != EscState::halted) enter(EscState::halted, "halt", last_);
    // What was sent may have been lost since: tell every line again, whatever it says.
    for (Motor& motor : motors_) motor.sent.reset();
    power_known_ = false;
    (void)drive(last_);
  } catch (const std::exception&) {  // no memory for a note: the lines come first
    for (const Motor& motor : motors_)
      (void)motor.line.channel->set_pulse(encode_pulse(config_.pulses.stop, config_.pulses.protocol));
    if (power_ != nullptr) (void)power_->set(false);
  }
}

hal::Result<> EscBank::resume(hal::Instant now) {
  if (state_ != EscState::halted) return not_now("resume");
  enter(EscState::stopped, "resumed", now);
  return drive(now);
}

hal::Result<> EscBank::clear_fault(hal::Instant now) {
  if (state_ != EscState::faulted) return not_now("clear the fault");
  FORAGER_TRY(drive(now));
  enter(EscState::stopped, "fault cleared", now);
  return {};
}

}  // namespace forager::flight
