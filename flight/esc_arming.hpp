#pragma once

#include <cstdint>
#include <string_view>

#include "hal/time.hpp"

namespace forager::flight {

// Times of one start of an ESC. Defaults hold for SimonK with room to spare: it wants more than 10
// consecutive stop pulses after its power-on beeps, any other pulse starts the count anew.
struct EscArmingTimes {
  int pulses_before_power = 11;                                  // on the line before the ESC has power
  hal::Duration beeps = std::chrono::milliseconds(1000);         // power-on melody, in which it may not count
  int pulses_to_arm = 11;                                        // more than 10
  hal::Duration low_at_least = std::chrono::milliseconds(2000);  // stop pulses after power, however fast
};

// The start of an ESC as a state machine of its own, without a line and without a switch: it says what the
// line must carry and whether the ESC may have power; EscBank obeys.
//
//   state    line  power  leaves it
//   low      stop  off    begin(), and pulses_before_power sent -> waking
//   waking   stop  on     beeps over -> counting
//   counting stop  on     pulses_to_arm sent and low_at_least since power -> armed
//   armed    idle or more  reset() -> low
//
// Where no switch is named, power is the operator's; low pulses are then on the line from construction on,
// long before. Everywhere but in armed the line carries the stop pulse: first pulses of 1460 us or more would
// start a calibration (SimonK).
class EscArming {
 public:
  enum class State : std::uint8_t { low, waking, counting, armed };

  // period: of the line; one pulse per period.
  EscArming(const EscArmingTimes& times, hal::Duration period, hal::Instant now)
      : times_(times), period_(period) {
    reset(now);
  }

  // The line carries the stop pulse from `now` on, for the first time or again; power off. From any state.
  void reset(hal::Instant now);
  // Asked to arm. Ignored unless low.
  void begin();
  void update(hal::Instant now);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool armed() const { return state_ == State::armed; }
  [[nodiscard]] bool power() const { return state_ != State::low; }
  // Whole stop pulses that the line has certainly carried since `from`.
  [[nodiscard]] std::int64_t pulses_since(hal::Instant from, hal::Instant now) const;

 private:
  void enter(State state, hal::Instant now);

  EscArmingTimes times_;
  hal::Duration period_;
  State state_ = State::low;
  bool asked_ = false;
  hal::Instant low_since_;
  hal::Instant powered_;
  hal::Instant entered_;
};

[[nodiscard]] std::string_view to_string(EscArming::State state);

}  // namespace forager::flight
