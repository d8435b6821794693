#pragma once

#include <optional>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// Split as the hardware splits it: a channel has a pulse of its own, but the period belongs to the timer and
// so to every channel of the group. Changing the period of one servo changes it for all its neighbours.

// One output that repeats a pulse. Logical, not electrical: a pulse is the active part of the period, and
// whether active means high is said once, in the board file.
//
// Safe state: released, that is no pulses at all, at construction and after release(). Whether a servo
// without pulses stays where it is or goes limp depends on its make, so a driver that must hold something
// sets a pulse instead of releasing. When the program dies, the hardware goes on with the last pulse (a PWM
// chip, a kernel timer) or stops (software): docs/safety.md says which.
class PwmChannel {
 public:
  virtual ~PwmChannel() = default;

  // Repeats pulses of this length from the next period on; a released channel starts with it, never with an
  // older one. The hardware rounds to its own steps: pulse() says what came out of it.
  // Errors: invalid_argument (negative, or longer than the group's period; nothing was sent), permission
  // (not in the group that owns the device), busy (another program holds the channel), no_ack (chip absent
  // from the bus, unpowered or at another address), timeout, disconnected (adapter unplugged), refused (the
  // autopilot has another use for this output), io (bus or kernel failed). After an error the output is
  // what it was, or, for no_ack, timeout and io, unknown: set again or release.
  [[nodiscard]] Result<> set_pulse(Duration length) { return do_set_pulse(length); }

  // Stops the pulses; the line rests at its inactive level. Errors as set_pulse().
  [[nodiscard]] Result<> release() { return do_release(); }

  // The length the hardware was last told, after its rounding; nothing while released.
  [[nodiscard]] std::optional<Duration> pulse() const { return do_pulse(); }

  // What a person calls it: "pwm pwmchip0/1", "pca9685 0x40 channel 3".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_set_pulse(Duration length) = 0;
  virtual Result<> do_release() = 0;
  [[nodiscard]] virtual std::optional<Duration> do_pulse() const = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

// The timer behind one or more channels.
class PwmGroup {
 public:
  virtual ~PwmGroup() = default;

  // From now on every channel of the group repeats after this long; pulses keep their length. The hardware
  // rounds to what its clock can divide: period() says what came out of it (a PCA9685 asked for 333 Hz gives
  // 339.1 Hz). Errors: invalid_argument (not positive, or shorter than a pulse one of the channels makes),
  // unsupported (outside what the timer can do), and those of PwmChannel::set_pulse().
  [[nodiscard]] Result<> set_period(Duration period) { return do_set_period(period); }

  // The true period, after rounding. Positive.
  [[nodiscard]] Duration period() const { return do_period(); }

  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_set_period(Duration period) = 0;
  [[nodiscard]] virtual Duration do_period() const = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
