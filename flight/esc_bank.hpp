#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flight/esc_arming.hpp"
#include "flight/esc_calibration.hpp"
#include "flight/esc_pulse.hpp"
#include "flight/motor_authority.hpp"
#include "flight/props_off.hpp"
#include "hal/digital_out.hpp"
#include "hal/halt.hpp"
#include "hal/journal.hpp"
#include "hal/pwm.hpp"

namespace forager::flight {

// A motor and the line its ESC listens to.
struct EscLine {
  std::string name;  // "front-left"
  hal::PwmChannel* channel = nullptr;
};

struct EscBankConfig {
  EscPulses pulses{};
  EscArmingTimes arming{};
  EscCalibrationTimes calibration{};
  double rise_per_s = 0.5;  // of the throttle: full after two seconds
  double fall_per_s = 2.0;  // when told less; a stop is at once
  // 1380 us: below the 1460 us that an ESC which gets its power too late would take for a calibration.
  double most_throttle = 0.4;
  // A command older than this is none. Shorter than the 131 ms after which an ESC stops by itself, so that
  // ours is always the first stop.
  hal::Duration command_max_age = std::chrono::milliseconds(100);
};

// Errors: invalid_argument (a rate that is not positive, a throttle limit outside 0..1, a command age not
// between 0 and 131 ms, times that are negative, fewer than 11 arming pulses), and those of
// validate(EscPulses).
[[nodiscard]] hal::Result<> validate(const EscBankConfig& config, hal::Duration period);

enum class EscState : std::uint8_t {
  stopped,      // stop pulses, no power where it can be switched
  arming,       // stop pulses, counted
  armed,        // idle, or the throttle commanded
  calibrating,  // levels of the calibration
  faulted,      // an output failed: every line is told to stop, again and again
  halted,       // stop pulses until resume()
};
[[nodiscard]] std::string_view to_string(EscState state);

// The ESCs of one vehicle, driven by pulses from here instead of by the autopilot; for the bench. All do the
// same thing at the same time but for their throttle.
//
//   stopped      arm() -> arming; calibrate() -> calibrating
//   arming       sequence over (EscArming) -> armed; disarm() -> stopped
//   armed        disarm(), or no command for command_max_age -> stopped: it must be armed anew
//   calibrating  over (EscCalibration), or disarm() -> stopped
//   faulted      clear_fault() and all outputs answer -> stopped
//   halted       resume() -> stopped
// From every state: halt() -> halted; an output that fails -> faulted.
//
// Safe state: the stop pulse on every line and the power switch off - at construction, before power; at
// halt(); when a command is stale; when an output fails; at destruction. A program that dies leaves what the
// outputs leave (docs/safety.md): the ESCs stop by themselves 131 ms after the pulses end.
//
// Every transition and every change of a pulse is noted in the journal: "front-left 1060.0 us". update()
// allocates only when it notes, and while an output fails.
class EscBank final : public hal::Halt {
 public:
  static constexpr std::size_t kMost = 16;

  // Borrows group, channels, power and journal; all channels belong to `group`, whose period must have been
  // set. power: the ESCs' supply, if the program can switch it; else null. Errors: those of validate();
  // invalid_state (an authority that was moved from), invalid_argument (no line or more than kMost, a null
  // channel, a channel that rounds the stop pulse to above idle), and those of the outputs.
  [[nodiscard]] static hal::Result<std::unique_ptr<EscBank>> create(
      MotorAuthority motors, const hal::PwmGroup& group, std::vector<EscLine> lines, hal::DigitalOut* power,
      hal::Journal& journal, const EscBankConfig& config, hal::Instant now);
  ~EscBank() override;  // halts
  EscBank(const EscBank&) = delete;
  EscBank& operator=(const EscBank&) = delete;

  // Errors of all three: invalid_state (not stopped).
  [[nodiscard]] hal::Result<> arm(const PropsOff& word, hal::Instant now);
  // Without a power switch the caller must have asked a person to disconnect the ESCs first, and must tell
  // that person to connect them once line_high() holds.
  [[nodiscard]] hal::Result<> calibrate(const PropsOff& word, hal::Instant now);
  // Stop, from arming, armed or calibrating.
  void disarm(std::string_view why, hal::Instant now);

  // 0..1 for each line; valid until command_max_age from `now`. Errors: invalid_state (not armed),
  // invalid_argument (another number of lines, a value outside 0..1); the command before then holds.
  [[nodiscard]] hal::Result<> command(std::span<const double> throttle, hal::Instant now);

  // To be called often: ramps, counts, judges the age of the command and moves the lines.
  void update(hal::Instant now);

  [[nodiscard]] EscState state() const { return state_; }
  [[nodiscard]] const std::string& reason() const { return reason_; }  // of the last transition
  [[nodiscard]] EscArming::State arming() const { return arming_.state(); }
  [[nodiscard]] EscCalibration::State calibration() const { return calibration_.state(); }
  [[nodiscard]] bool line_high() const { return calibration_.line_high(); }
  [[nodiscard]] bool powered() const { return powered_; }
  [[nodiscard]] std::size_t size() const { return motors_.size(); }
  [[nodiscard]] std::string_view name(std::size_t i) const { return motors_[i].line.name; }
  // Throttle in force, ramp included, and the pulse last told, in PWM terms.
  [[nodiscard]] double throttle(std::size_t i) const { return motors_[i].throttle; }
  [[nodiscard]] std::optional<hal::Duration> pulse(std::size_t i) const { return motors_[i].sent; }

  void halt() noexcept override;
  // Out of halted. Errors: invalid_state (not halted).
  [[nodiscard]] hal::Result<> resume(hal::Instant now);
  // Out of faulted. Errors: invalid_state (not faulted), and those of the output that still fails.
  [[nodiscard]] hal::Result<> clear_fault(hal::Instant now);

 private:
  struct Motor {
    EscLine line;
    double wanted = 0.0;
    double throttle = 0.0;
    std::optional<hal::Duration> sent;  // nothing: never, or it failed
  };

  EscBank(MotorAuthority motors, hal::Duration period, std::vector<EscLine> lines, hal::DigitalOut* power,
          hal::Journal& journal, const EscBankConfig& config, hal::Instant now);
  [[nodiscard]] hal::Result<> begin(hal::Instant now);
  void enter(EscState state, std::string_view why, hal::Instant now);
  void advance(hal::Instant now);
  void ramp(double dt_s);
  [[nodiscard]] hal::Duration wanted_pulse(const Motor& motor) const;
  [[nodiscard]] bool wanted_power() const;
  [[nodiscard]] hal::Result<> drive(hal::Instant now);
  [[nodiscard]] hal::Result<> drive_line(Motor& motor, hal::Instant now);
  [[nodiscard]] hal::Result<> drive_power(hal::Instant now);
  [[nodiscard]] hal::Failure not_now(std::string_view operation) const;

  MotorAuthority authority_;
  std::vector<Motor> motors_;
  hal::DigitalOut* power_;
  hal::Journal* journal_;
  EscBankConfig config_;
  EscArming arming_;
  EscCalibration calibration_;
  EscState state_ = EscState::stopped;
  std::string reason_ = "construction";
  hal::Instant command_until_;
  hal::Instant last_;
  bool powered_ = false;
  bool power_known_ = false;  // the switch has been told
};

}  // namespace forager::flight
