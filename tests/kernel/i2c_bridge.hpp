#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "hal/i2c.hpp"

namespace forager::kernel {

// Puts an emulated bus behind the kernel's adapter /dev/i2c-7 (modules/i2c_sim.c): what a program or a driver
// of the kernel sends there arrives on `wires`, from a thread of the bridge. Between transfers the test may
// use the wires itself; a transfer is over when the call that made it returns. When the bridge ends the
// adapter is unplugged.
class I2cBridge {
 public:
  // `before`: called before each transfer, to let emulated chips know the time.
  explicit I2cBridge(hal::I2c& wires, std::function<void()> before = {});
  ~I2cBridge();
  I2cBridge(const I2cBridge&) = delete;
  I2cBridge& operator=(const I2cBridge&) = delete;

  // A bus that hangs: transfers are taken and never answered.
  void hang(bool on) { hangs_ = on; }

 private:
  void serve();
  void serve_one();

  hal::I2c& wires_;
  std::function<void()> before_;
  int device_ = -1;
  int stop_ = -1;
  std::atomic<bool> hangs_ = false;
  std::thread thread_;
};

}  // namespace forager::kernel
