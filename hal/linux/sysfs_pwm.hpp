#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/linux/kernel.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct SysfsPwmConfig {
  // A name in /sys/class/pwm, that of the device behind it ("fe20c000.pwm"), or the path of the chip's
  // folder.
  std::string chip = "pwmchip0";
  std::vector<std::uint32_t> channels;  // which of its channels
  bool inverted = false;                // the active part of the period is low
  Duration period = std::chrono::milliseconds(20);
  // After an export the channel's files belong to root until udev has run: for so long "no permission" is
  // tried again, every 5 ms.
  Duration settle = std::chrono::seconds(1);
};

// PWM channels of one chip through /sys/class/pwm, with the kernel's own timing.
//
// A channel that another program left exported and running keeps its pulses until it is told another one:
// servos that hold something must not be let go by a restart. For the same reason the end of this object
// leaves everything as it is; halting is the business of whoever drives the servo. After a crash the kernel
// goes on with the last pulses.
//
// A channel has one driver: its folder is locked (flock) for as long as the group lives, the kernel lets go
// of it when the program dies. That holds among programs that ask; who writes to sysfs without asking is not
// kept out.
//
// sysfs takes nanoseconds and gives them back as written; what the hardware rounds them to it does not say.
class SysfsPwm : public PwmGroup {
 public:
  [[nodiscard]] virtual PwmChannel& channel(std::size_t index) = 0;  // in the order of the configuration
};

// Exports and prepares the channels; waits on `clock` for udev, for at most `settle`. Both must outlive the
// group. Errors: not_present (no such chip or channel: overlay missing), permission (not in the group that
// owns the files, udev rule missing), busy (another driver of the kernel or another program has the channel,
// or it runs with the other polarity), invalid_argument (no channels, period not positive, or refused by the
// hardware), unsupported (the chip cannot invert).
[[nodiscard]] Result<std::unique_ptr<SysfsPwm>> open_sysfs_pwm(const SysfsPwmConfig& config, Clock& clock,
                                                               Kernel& kernel = real_kernel());

}  // namespace forager::hal
