#pragma once

#include <optional>
#include <string_view>

#include "hal/error.hpp"
#include "hal/halt.hpp"
#include "hal/time.hpp"

namespace forager::servo {

// What presses one brake: a servo, a solenoid, a linear actuator. 0 is open, 1 is locked.
//
// Safe state: locked. halt() commands locked at once, without slew, and is what a crash leaves behind only if
// the hardware says so (docs/safety.md). Nothing here waits: move() tells the hardware where to be by `now`
// and returns. What stays the same is told again twice a second, as the hardware may have lost it.
class BrakeActuator : public hal::Halt {
 public:
  // Goes towards `fraction`, as far as its slew limit allows since the last call. Errors: invalid_argument
  // (NaN; values outside [0, 1] are clamped), and those of the output behind it; then the brake may be
  // anywhere between where it was and where it was told to be.
  [[nodiscard]] hal::Result<> move(double fraction, hal::Instant now) { return do_move(fraction, now); }

  // The same without slew: for stopping.
  [[nodiscard]] hal::Result<> jump(double fraction, hal::Instant now) { return do_jump(fraction, now); }

  // Whatever was told may be lost: the next call tells it, even if nothing changed.
  void forget() { do_forget(); }

  // Where the last command that went out puts it, slew included; not a measurement.
  [[nodiscard]] double commanded() const { return do_commanded(); }

  // Where it is, measured; nothing if it has no sensor.
  [[nodiscard]] std::optional<double> measured() const { return do_measured(); }

  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual hal::Result<> do_move(double fraction, hal::Instant now) = 0;
  // For those without a slew limit, and those that tell everything every time.
  virtual hal::Result<> do_jump(double fraction, hal::Instant now) { return do_move(fraction, now); }
  virtual void do_forget() {}
  [[nodiscard]] virtual double do_commanded() const = 0;
  [[nodiscard]] virtual std::optional<double> do_measured() const { return std::nullopt; }
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

}  // namespace forager::servo
