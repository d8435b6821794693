#include "flight/esc_calibration.hpp"

namespace forager::flight {

std::string_view to_string(EscCalibration::State state) {
  switch (state) {
    case EscCalibration::State::off:
      return "off";
    case EscCalibration::State::cold:
      return "cold";
    case EscCalibration::State::high:
      return "high";
    case EscCalibration::State::low:
      return "low";
    case EscCalibration::State::done:
      return "done";
  }
  return "?";
}

EscLearned learned_from(const EscPulses& pulses) { return {pulses.stop * 17 / 16, pulses.high * 31 / 32}; }

void EscCalibration::begin(hal::Instant now) {
  state_ = switched_ ? State::cold : State::high;
  entered_ = now;
}

void EscCalibration::update(hal::Instant now) {
  const auto after = [&](hal::Duration time, State next) {
    if (now - entered_ < time) return;
    state_ = next;
    entered_ = now;
  };
  switch (state_) {
    case State::off:
    case State::done:
      return;
    case State::cold:
      return after(times_.cold, State::high);
    case State::high:
      return after(times_.high + (switched_ ? hal::Duration::zero() : times_.connect), State::low);
    case State::low:
      return after(times_.low, State::done);
  }
}

}  // namespace forager::flight
