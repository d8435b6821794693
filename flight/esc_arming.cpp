#include "flight/esc_arming.hpp"

namespace forager::flight {

std::string_view to_string(EscArming::State state) {
  switch (state) {
    case EscArming::State::low:
      return "low";
    case EscArming::State::waking:
      return "waking";
    case EscArming::State::counting:
      return "counting";
    case EscArming::State::armed:
      return "armed";
  }
  return "?";
}

void EscArming::reset(hal::Instant now) {
  asked_ = false;
  low_since_ = now;
  enter(State::low, now);
}

void EscArming::begin() {
  if (state_ == State::low) asked_ = true;
}

void EscArming::update(hal::Instant now) {
  if (state_ == State::low && asked_ && pulses_since(low_since_, now) >= times_.pulses_before_power) {
    powered_ = now;
    enter(State::waking, now);
  }
  if (state_ == State::waking && now - entered_ >= times_.beeps) enter(State::counting, now);
  if (state_ == State::counting && pulses_since(entered_, now) >= times_.pulses_to_arm &&
      now - powered_ >= times_.low_at_least)
    enter(State::armed, now);
}

std::int64_t EscArming::pulses_since(hal::Instant from, hal::Instant now) const {
  // The first pulse may have been half over at `from`, and the last may still be going on.
  const std::int64_t periods = (now - from) / period_;
  return periods > 0 ? periods - 1 : 0;
}

void EscArming::enter(State state, hal::Instant now) {
  state_ = state;
  entered_ = now;
}

}  // namespace forager::flight
