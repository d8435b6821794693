#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/digital_out.hpp"
#include "hal/error.hpp"
#include "hal/linux/jitter.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct SoftwarePwmLine {
  std::unique_ptr<DigitalOut> line;  // inactive between pulses
  // What the channel does when nobody feeds any more: this pulse, or with nothing, no pulses.
  std::optional<Duration> stale_pulse{};
};

struct SoftwarePwmConfig {
  Duration period = std::chrono::milliseconds(20);
  // Silence of feed() for longer than this is a hang of whoever commands; zero: never.
  Duration stale_after{};
  int priority = 50;  // of SCHED_FIFO, 1 to 99
};

// How real the time of the thread is.
struct RealTimeFacts {
  bool real_time = false;      // runs under SCHED_FIFO
  bool memory_locked = false;  // is never paged out
  std::string text;            // "SCHED_FIFO 50, memory locked", or why not, with the mend
};

// Pulses on ordinary digital lines, made by one real-time thread for all channels: the one thread of this
// library (docs/decisions/0006-one-real-time-thread.md). For brake servos, whose pad does not care for some
// microseconds; never for ESCs: a thread that is kept away for milliseconds in the middle of a pulse makes it
// so much longer, and a longer pulse there is more throttle.
//
// Safe state: lines inactive, no pulses, at construction and at the end of the object. While the commanding
// loop hangs the thread goes on with the stale pulse (a locked brake). When the process stops or dies pulses
// end: what the servo does then depends on its make.
//
// set_pulse() and release() take effect with the next period and never wait. A line that fails says so at the
// next set_pulse() after the edge that failed, and is tried again every period.
class SoftwarePwm : public PwmGroup {
 public:
  [[nodiscard]] virtual PwmChannel& channel(std::size_t index) = 0;  // in the order of the lines
  // Whoever commands the channels lives.
  virtual void feed() = 0;
  // How much too long pulses are, and how late they begin.
  [[nodiscard]] virtual const Jitter& pulse_jitter() const = 0;
  [[nodiscard]] virtual const Jitter& start_jitter() const = 0;
  [[nodiscard]] virtual std::uint64_t missed_periods() const = 0;
  [[nodiscard]] virtual const RealTimeFacts& facts() const = 0;
};

// Takes the lines and starts the thread. Without the right to SCHED_FIFO or to lock memory it goes without
// and facts() says so. Errors: invalid_argument (no line, more than 16, a period shorter than 1 ms, a stale
// pulse that is not from 0 to the period, a priority outside 1 to 99), io (no more threads).
[[nodiscard]] Result<std::unique_ptr<SoftwarePwm>> open_software_pwm(std::vector<SoftwarePwmLine> lines,
                                                                     const SoftwarePwmConfig& config);

}  // namespace forager::hal
