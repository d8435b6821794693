#pragma once

#include <string>

#include "servo/brake_actuator.hpp"
#include "servo/servo.hpp"

namespace forager::servo {

// Pulses of one brake servo. Default: the laboratory's left brake, whose servo is neutral at 1180 us and
// presses from 1700 to 1750 us; the right one presses from 1750 to 2000 us.
struct PwmBrakeConfig {
  hal::Duration open_pulse = std::chrono::microseconds(1180);
  hal::Duration locked_pulse = std::chrono::microseconds(1725);
  hal::Duration trim{};
  hal::Duration min_pulse = std::chrono::microseconds(1000);
  hal::Duration max_pulse = std::chrono::microseconds(2000);
  double slew_per_s = 10.0;       // travels per second
  AtHalt at_halt = AtHalt::hold;  // a brake that is not self-locking must be held
};
[[nodiscard]] PwmBrakeConfig laboratory_left();
[[nodiscard]] PwmBrakeConfig laboratory_right();

// A servo that presses a brake. Safe place: locked.
class PwmBrake final : public BrakeActuator {
 public:
  // Borrows the channel. Errors: those of PulseMap::between() and Servo::create().
  [[nodiscard]] static hal::Result<PwmBrake> create(hal::PwmChannel& channel, const PwmBrakeConfig& config);
  [[nodiscard]] const Servo& servo() const { return servo_; }
  void halt() noexcept override { servo_.halt(); }

 private:
  explicit PwmBrake(Servo servo) : servo_(std::move(servo)) {}
  hal::Result<> do_move(double fraction, hal::Instant now) override { return servo_.move(fraction, now); }
  hal::Result<> do_jump(double fraction, hal::Instant now) override { return servo_.jump(fraction, now); }
  void do_forget() override { servo_.forget(); }
  [[nodiscard]] double do_commanded() const override { return servo_.place(); }
  [[nodiscard]] std::string_view do_name() const override { return servo_.channel().name(); }

  Servo servo_;
};

}  // namespace forager::servo
