#pragma once

#include <memory>
#include <string>

#include "hal/i2c.hpp"
#include "hal/linux/kernel.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct I2cDevConfig {
  std::string device = "/dev/i2c-1";
  Duration timeout =
      std::chrono::milliseconds(20);  // of one transfer; the kernel rounds it up to 10 ms steps
};

// An adapter of the kernel through i2c-dev, each transfer one I2C_RDWR. Errors of opening: not_present (the
// bus is not enabled, or i2c-dev is not loaded), permission, unsupported (an adapter that knows SMBus
// commands only), io.
[[nodiscard]] Result<std::unique_ptr<I2c>> open_i2c_dev(const I2cDevConfig& config,
                                                        Kernel& kernel = real_kernel());

}  // namespace forager::hal
