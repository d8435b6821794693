#include "mocks/sim_esc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::mocks {
namespace {

constexpr int kOneshotShare = 8;

double us(hal::Duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

}  // namespace

std::string_view to_string(SimEscState state) {
  switch (state) {
    case SimEscState::off:
      return "off";
    case SimEscState::beeping:
      return "beeping";
    case SimEscState::waiting:
      return "waiting";
    case SimEscState::learning_full:
      return "learning full";
    case SimEscState::learning_stop:
      return "learning stop";
    case SimEscState::armed:
      return "armed";
  }
  return "?";
}

SimEsc::SimEsc(std::string name, const SimEscParameters& parameters, hal::Journal* journal)
    : name_(std::move(name)),
      parameters_(parameters),
      journal_(journal),
      stop_(parameters.stop),
      full_(parameters.full) {}

void SimEsc::set_power(bool on, hal::Instant now) {
  if (on == (state_ != SimEscState::off)) return;
  turn(now);
  drive_ = 0.0;
  first_ = true;
  silent_ = false;
  count_ = 0;
  powered_ = last_pulse_ = now;
  enter(on ? SimEscState::beeping : SimEscState::off, on ? "power on, beeps" : "power off", now);
}

void SimEsc::pulse(hal::Duration length, hal::Instant now) {
  update(now);
  if (state_ == SimEscState::off || state_ == SimEscState::beeping) return;
  ++pulses_;
  const bool eighth = length >= parameters_.oneshot_from && length <= parameters_.oneshot_to;
  const hal::Duration meant = eighth ? length * kOneshotShare : length;
  if (meant < parameters_.least || meant > parameters_.most) {
    ++thrown_away_;
    return;
  }
  oneshot_ = eighth;
  last_pulse_ = now;
  silent_ = false;
  if (parameters_.note_pulses) note(fmt::format("pulse {:.1f} us", us(length)), now);
  switch (state_) {
    case SimEscState::off:
    case SimEscState::beeping:
      return;
    case SimEscState::waiting:
      return wait(meant, now);
    case SimEscState::learning_full:
    case SimEscState::learning_stop:
      return learn(meant, now);
    case SimEscState::armed:
      return follow(meant);
  }
}

void SimEsc::wait(hal::Duration length, hal::Instant now) {
  const hal::Duration middle = (stop_ + full_) / 2;
  if (first_ && parameters_.calibration && length >= middle) {
    first_ = false;
    count_ = 0;
    ++calibrations_begun_;
    enter(SimEscState::learning_full, "high pulses after power-on: calibration", now);
    return learn(length, now);
  }
  first_ = false;
  count_ = length <= stop_ ? count_ + 1 : 0;
  if (count_ <= parameters_.pulses_to_arm) return;
  ++armings_;
  enter(SimEscState::armed, "armed, long beep", now);
}

void SimEsc::learn(hal::Duration length, hal::Instant now) {
  const bool full = state_ == SimEscState::learning_full;
  // The low level is one below the middle of what has just been learnt.
  if (!full && length >= learnt_full_ * 3 / 4) return;
  if (count_ == 0 || std::chrono::abs(length - level_) > parameters_.calibration_window) {
    count_ = 0;
    sum_ = {};
    level_ = length;
  }
  sum_ += length;
  if (++count_ < parameters_.calibration_pulses) return;
  const hal::Duration mean = sum_ / count_;
  count_ = 0;
  if (full) {
    learnt_full_ = mean * 31 / 32;
    enter(SimEscState::learning_stop, "one beep: full learnt", now);
    return;
  }
  stop_ = mean * 17 / 16;
  full_ = learnt_full_;
  ++calibrations_done_;
  enter(SimEscState::waiting,
        fmt::format("two beeps: stop {:.1f} us, full {:.1f} us stored", us(stop_), us(full_)), now);
}

void SimEsc::follow(hal::Duration length) {
  const double travel = us(full_) - us(stop_);
  drive_ = std::clamp((us(length) - us(stop_)) / travel, 0.0, 1.0);
}

void SimEsc::update(hal::Instant now) {
  if (state_ == SimEscState::beeping && now - powered_ >= parameters_.beeps) {
    last_pulse_ = now;
    enter(SimEscState::waiting, "beeps over", now);
  }
  const hal::Duration silence = now - last_pulse_;
  if (state_ == SimEscState::waiting && silence >= parameters_.motor_stops) count_ = 0;
  if (state_ == SimEscState::armed && silence >= parameters_.motor_stops && !silent_) {
    turn(last_pulse_ + parameters_.motor_stops);
    drive_ = 0.0;
    silent_ = true;
    note("no pulses: motor off", now);
  }
  if (state_ == SimEscState::armed && silence >= parameters_.forgets) {
    count_ = 0;
    enter(SimEscState::waiting, "no pulses for long: disarmed", now);
  }
  turn(now);
}

void SimEsc::turn(hal::Instant now) {
  if (now <= turned_) return;
  const double keep = std::exp(-hal::to_seconds(now - turned_) / parameters_.spin_lag_s);
  spin_ = drive_ + (spin_ - drive_) * keep;
  most_spin_ = std::max(most_spin_, spin_);
  turned_ = now;
}

void SimEsc::enter(SimEscState state, std::string_view sign, hal::Instant now) {
  state_ = state;
  note(sign, now);
}

void SimEsc::note(std::string_view text, hal::Instant now) {
  if (journal_ != nullptr) journal_->note(now, name_, text);
}

void SimEscWire::update(hal::Instant now) {
  const std::optional<hal::Duration> pulse = channel_->pulse();
  if (!pulse || cut_) {
    next_.reset();
    esc_->update(now);
    return;
  }
  if (!next_) next_ = now + group_->period();
  for (; *next_ <= now; *next_ += group_->period()) esc_->pulse(*pulse, *next_);
  esc_->update(now);
}

}  // namespace forager::mocks
