#pragma once

#include <gtest/gtest.h>

#include "hal/i2c.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "servo/pca9685.hpp"
#include "tests/hal/pwm_contract.hpp"

namespace forager::servo {

// The driver on `bus`, whose other end is the emulated chip on `wires`: the same bus, or a kernel between
// them.
class Pca9685Rig : public hal::contract::PwmRig {
 public:
  Pca9685Rig(hal::I2c& bus, mocks::SimI2cBus& wires) : wires_(wires), chip_(bus, nullptr, journal_, {}) {
    wires_.attach(0x40, sim_);
    EXPECT_TRUE(chip_.open(now_));
  }
  hal::PwmGroup& group() override { return chip_; }
  hal::PwmChannel& channel(std::size_t index) override { return chip_.channel(index); }
  std::optional<hal::Duration> pulse_at_pin(std::size_t index) override { return sim_.pulse(index); }
  hal::Duration period_at_pin() override { return sim_.period(); }
  hal::Duration rounding() override { return std::chrono::nanoseconds(2441); }
  void settle() override {
    for (int i = 0; i < 3; ++i) {
      now_ += std::chrono::milliseconds(1);
      sim_.advance(now_);
      EXPECT_TRUE(chip_.update(now_));
    }
  }
  void unplug(bool out) override { wires_.disconnect(out); }

 private:
  hal::Instant now_{std::chrono::seconds(1)};
  hal::NullJournal journal_;
  mocks::SimI2cBus& wires_;
  mocks::SimPca9685 sim_;
  Pca9685 chip_;
};

}  // namespace forager::servo
