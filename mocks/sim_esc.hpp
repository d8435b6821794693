#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/journal.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::mocks {

// An ESC with SimonK firmware (tgy.asm), as far as its line can tell. Times in PWM terms.
struct SimEscParameters {
  hal::Duration stop = std::chrono::microseconds(1060);  // up to here the motor stands
  hal::Duration full = std::chrono::microseconds(1860);
  hal::Duration least = std::chrono::microseconds(768);        // shorter pulses are thrown away
  hal::Duration most = std::chrono::microseconds(2400);        // longer ones too
  hal::Duration oneshot_from = std::chrono::microseconds(96);  // shorter still: pulses of one eighth
  hal::Duration oneshot_to = std::chrono::microseconds(300);
  int pulses_to_arm = 10;  // it wants more than these
  bool calibration = true;
  int calibration_pulses = 32;
  hal::Duration calibration_window = std::chrono::microseconds(10);
  hal::Duration beeps = std::chrono::milliseconds(600);           // after power-on; hears nothing meanwhile
  hal::Duration motor_stops = std::chrono::microseconds(131072);  // silence: two rounds of a 16-bit timer
  hal::Duration forgets = std::chrono::milliseconds(2000);        // silence: disarmed
  double spin_lag_s = 0.08;                                       // of motor and propeller; assumption
  bool note_pulses = false;                                       // every pulse in the journal
};

enum class SimEscState : std::uint8_t {
  off,
  beeping,
  waiting,        // for stop pulses
  learning_full,  // calibration
  learning_stop,
  armed,  // follows the pulses
};
[[nodiscard]] std::string_view to_string(SimEscState state);

// Behaves like the device at the other end of the line: knows nothing of what drives it.
class SimEsc {
 public:
  SimEsc(std::string name, const SimEscParameters& parameters, hal::Journal* journal = nullptr);

  void set_power(bool on, hal::Instant now);
  // One pulse that ended at `now`; electrical length.
  void pulse(hal::Duration length, hal::Instant now);
  // The silence since the last pulse, and the motor, up to `now`.
  void update(hal::Instant now);

  [[nodiscard]] SimEscState state() const { return state_; }
  [[nodiscard]] double drive() const { return drive_; }  // share of full power put into the motor
  [[nodiscard]] double spin() const { return spin_; }    // share of full speed
  [[nodiscard]] double most_spin() const { return most_spin_; }
  [[nodiscard]] bool oneshot() const { return oneshot_; }           // as last detected
  [[nodiscard]] hal::Duration stop_pulse() const { return stop_; }  // in force: learnt, or the default
  [[nodiscard]] hal::Duration full_pulse() const { return full_; }
  [[nodiscard]] std::uint64_t pulses() const { return pulses_; }
  [[nodiscard]] std::uint64_t thrown_away() const { return thrown_away_; }
  [[nodiscard]] std::uint32_t armings() const { return armings_; }
  [[nodiscard]] std::uint32_t calibrations_begun() const { return calibrations_begun_; }
  [[nodiscard]] std::uint32_t calibrations_done() const { return calibrations_done_; }

 private:
  void enter(SimEscState state, std::string_view sign, hal::Instant now);
  void wait(hal::Duration length, hal::Instant now);
  void learn(hal::Duration length, hal::Instant now);
  void follow(hal::Duration length);
  void turn(hal::Instant now);
  void note(std::string_view text, hal::Instant now);

  std::string name_;
  SimEscParameters parameters_;
  hal::Journal* journal_;
  SimEscState state_ = SimEscState::off;
  hal::Duration stop_;
  hal::Duration full_;
  hal::Duration learnt_full_{};
  hal::Instant powered_;
  hal::Instant last_pulse_;
  hal::Instant turned_;
  bool first_ = false;  // no valid pulse since power-on
  bool oneshot_ = false;
  bool silent_ = false;
  int count_ = 0;
  hal::Duration sum_{};
  hal::Duration level_{};
  double drive_ = 0.0;
  double spin_ = 0.0;
  double most_spin_ = 0.0;
  std::uint64_t pulses_ = 0;
  std::uint64_t thrown_away_ = 0;
  std::uint32_t armings_ = 0;
  std::uint32_t calibrations_begun_ = 0;
  std::uint32_t calibrations_done_ = 0;
};

// The wire between an output that repeats a pulse and an ESC: makes the single pulses, one at the end of
// every period, of the length the output has at the time of the call.
class SimEscWire {
 public:
  SimEscWire(const hal::PwmChannel& channel, const hal::PwmGroup& group, SimEsc& esc)
      : channel_(&channel), group_(&group), esc_(&esc) {}

  void cut(bool cut) { cut_ = cut; }  // a broken wire
  void update(hal::Instant now);

 private:
  const hal::PwmChannel* channel_;
  const hal::PwmGroup* group_;
  SimEsc* esc_;
  std::optional<hal::Instant> next_;
  bool cut_ = false;
};

}  // namespace forager::mocks
