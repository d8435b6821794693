#pragma once

#include <cstdint>
#include <string_view>

#include "flight/esc_pulse.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// SimonK averages each level over 32 pulses within +-10 us and beeps; two seconds leave room for its melody.
struct EscCalibrationTimes {
  hal::Duration cold = std::chrono::milliseconds(3000);      // without power first: capacitors keep it alive
  hal::Duration connect = std::chrono::milliseconds(15000);  // for a person to connect it, without a switch
  hal::Duration high = std::chrono::milliseconds(2000);
  hal::Duration low = std::chrono::milliseconds(2000);
};

// What an ESC has learnt from two levels.
struct EscLearned {
  hal::Duration stop;  // 17/16 of the low level: 1000 us -> 1062.5 us
  hal::Duration full;  // 31/32 of the high level: 2000 us -> 1937.5 us
};
[[nodiscard]] EscLearned learned_from(const EscPulses& pulses);

// Teaches ESCs where stop and full are, as a state machine of its own; EscBank obeys. The only thing in this
// program that puts a long pulse on the line of an ESC that wakes.
//
//   state    line  power  leaves it
//   off      stop  off    begin() -> cold
//   cold     stop  off    `cold` over -> high; skipped without a switch: the person has said so
//   high     high  on     `high` over (without a switch `connect` more) -> low
//   low      stop  on     `low` over -> done
//   done     stop  off    begin() -> cold
//
// From every state abort() -> off. An ESC aborted between the levels may keep either; calibrate it again.
class EscCalibration {
 public:
  enum class State : std::uint8_t { off, cold, high, low, done };

  EscCalibration(const EscCalibrationTimes& times, bool switched) : times_(times), switched_(switched) {}

  void begin(hal::Instant now);
  void abort() { state_ = State::off; }
  void update(hal::Instant now);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool active() const { return state_ != State::off && state_ != State::done; }
  [[nodiscard]] bool line_high() const { return state_ == State::high; }
  [[nodiscard]] bool power() const { return state_ == State::high || state_ == State::low; }

 private:
  EscCalibrationTimes times_;
  bool switched_;
  State state_ = State::off;
  hal::Instant entered_;
};

[[nodiscard]] std::string_view to_string(EscCalibration::State state);

}  // namespace forager::flight
