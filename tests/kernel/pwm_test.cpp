// The sysfs PWM backend on a PWM chip of the kernel (modules/pwm_sim.c), and on the kernel's own driver of a
// PCA9685.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <sstream>

#include "hal/linux/i2c_dev.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/linux/sysfs_pwm.hpp"
#include "tests/kernel/i2c_bridge.hpp"
#include "tests/kernel/sysfs.hpp"
#include "tests/kernel/user.hpp"
#include "tests/servo/pca9685_rig.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::Duration;
using hal::ErrorCode;
using testing::HasSubstr;
using testing::IsEmpty;

// What the chip's pins do. Its end takes every channel back from user space.
class PwmSim {
 public:
  struct Output {
    std::int64_t period = 0;
    std::int64_t duty = 0;
    bool inverted = false;
    bool enabled = false;
  };
  ~PwmSim() {
    fail_with(0);
    for (unsigned i = 0; i < 4; ++i) {
      const std::string channel = folder() + "/pwm" + std::to_string(i);
      static_cast<void>(put_error(channel + "/enable", "0"));
      static_cast<void>(put_error(channel + "/polarity", "normal"));
      static_cast<void>(put_error(folder() + "/unexport", std::to_string(i)));
    }
  }
  [[nodiscard]] static std::string folder() { return "/sys/class/pwm/pwmchip0"; }
  [[nodiscard]] static Output output(std::size_t index) {
    std::istringstream lines(get("/sys/devices/platform/pwm-sim/outputs"));
    Output output;
    for (std::size_t i = 0; i <= index; ++i)
      lines >> output.period >> output.duty >> output.inverted >> output.enabled;
    return output;
  }
  static void fail_with(int error) { put("/sys/devices/platform/pwm-sim/error", std::to_string(error)); }
};

class PwmOnAKernel : public testing::Test {
 protected:
  hal::Result<std::unique_ptr<hal::SysfsPwm>> open(hal::SysfsPwmConfig config) {
    config.chip = "pwm-sim";
    return hal::open_sysfs_pwm(config, *clock_);
  }
  PwmSim sim_;
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
};

TEST_F(PwmOnAKernel, TheChipIsFoundByItsDeviceWhateverItsNumber) {
  EXPECT_TRUE(hal::open_sysfs_pwm({.chip = "pwm-sim", .channels = {3}}, *clock_));
  EXPECT_TRUE(hal::open_sysfs_pwm({.chip = "pwmchip0", .channels = {0}}, *clock_));
  const auto none = hal::open_sysfs_pwm({.chip = "pwmchip9", .channels = {0}}, *clock_);
  ASSERT_FALSE(none);
  EXPECT_EQ(ErrorCode::not_present, none.error().code);
  const auto beyond = open({.channels = {4}});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(ErrorCode::not_present, beyond.error().code);
  EXPECT_THAT(describe(beyond.error()), HasSubstr("pwmchip0/4"));
}

TEST_F(PwmOnAKernel, PolarityReachesThePin) {
  const auto pwm = open({.channels = {1}, .inverted = true});
  ASSERT_TRUE(pwm) << describe(pwm.error());
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1180us));
  EXPECT_TRUE(sim_.output(1).inverted && sim_.output(1).enabled);
  EXPECT_EQ(1'180'000, sim_.output(1).duty);
}

TEST_F(PwmOnAKernel, WhatWasLeftRunningGoesOn) {
  {
    const auto first = open({.channels = {0}});
    ASSERT_TRUE((*first)->channel(0).set_pulse(1725us));
  }
  ASSERT_TRUE(sim_.output(0).enabled) << "the kernel goes on without the program";
  const auto second = open({.channels = {0}});
  ASSERT_TRUE(second) << describe(second.error());
  EXPECT_EQ(1725us, (*second)->channel(0).pulse());
  EXPECT_TRUE(sim_.output(0).enabled);
}

TEST_F(PwmOnAKernel, FailuresOfTheHardwareHaveNames) {
  const auto pwm = open({.channels = {0}}).value();
  const auto code = [&](int error) {
    PwmSim::fail_with(error);
    return pwm->channel(0).set_pulse(1500us).error().code;
  };
  EXPECT_EQ(ErrorCode::io, code(EIO));
  EXPECT_EQ(ErrorCode::no_ack, code(ENXIO));
  EXPECT_EQ(ErrorCode::timeout, code(ETIMEDOUT));
  EXPECT_EQ(ErrorCode::invalid_argument, code(EINVAL));
  PwmSim::fail_with(0);
  EXPECT_TRUE(pwm->channel(0).set_pulse(1500us));
}

// The export, the wait for udev and the pulse itself, without being root.
TEST_F(PwmOnAKernel, NobodyMayNotAndTheGroupMay) {
  const auto try_it = [] {
    const auto clock = hal::make_steady_clock();
    const auto pwm = hal::open_sysfs_pwm({.chip = "pwm-sim", .channels = {2}}, *clock);
    if (!pwm) return std::string(to_string(pwm.error().code)) + ": " + describe(pwm.error());
    const auto set = (*pwm)->channel(0).set_pulse(1300us);
    return set ? std::string("runs") : describe(set.error());
  };
  const std::string refused = as_nobody({}, try_it);
  EXPECT_THAT(refused, HasSubstr("permission: pwm pwmchip0/2: export: "));
  EXPECT_THAT(refused, HasSubstr("99-forager.rules"));
  EXPECT_EQ("runs", as_nobody({"gpio"}, try_it));
  EXPECT_EQ(1'300'000, sim_.output(2).duty);
}

class SimRig final : public hal::contract::PwmRig {
 public:
  SimRig() { pwm_ = hal::open_sysfs_pwm({.chip = "pwm-sim", .channels = {0, 1}}, *clock_).value(); }
  hal::PwmGroup& group() override { return *pwm_; }
  hal::PwmChannel& channel(std::size_t index) override { return pwm_->channel(index); }
  std::optional<Duration> pulse_at_pin(std::size_t index) override {
    const PwmSim::Output output = sim_.output(index);
    return output.enabled ? std::optional(Duration(output.duty)) : std::nullopt;
  }
  Duration period_at_pin() override { return Duration(sim_.output(0).period); }
  Duration rounding() override { return 0ns; }
  void unplug(bool out) override { PwmSim::fail_with(out ? ENODEV : 0); }

 private:
  PwmSim sim_;
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
  std::unique_ptr<hal::SysfsPwm> pwm_;
};

// The kernel's own driver of the PCA9685 takes the emulated chip for a real one, and moves it as ours does.
TEST(Pca9685OnAKernel, TheKernelsOwnDriverIsContentWithTheEmulator) {
  const auto clock = hal::make_steady_clock();
  mocks::SimI2cBus wires("wires");
  mocks::SimPca9685 chip;
  wires.attach(0x41, chip);
  const I2cBridge bridge(wires, [&] { chip.advance(clock->now()); });
  const auto bus = hal::open_i2c_dev({.device = "/dev/i2c-7", .timeout = 2s});  // for the driver, too
  const std::string adapter = "/sys/bus/i2c/devices/i2c-7";
  ASSERT_TRUE(put(adapter + "/new_device", "pca9685 0x41"));
  {
    const auto pwm = hal::open_sysfs_pwm({.chip = "7-0041", .channels = {5}, .period = 5ms}, *clock);
    ASSERT_TRUE(pwm) << describe(pwm.error());
    ASSERT_TRUE((*pwm)->channel(0).set_pulse(1250us));
    chip.advance(clock->now() + 1s);
    ASSERT_TRUE(chip.pulse(5).has_value());
    EXPECT_LT(std::chrono::abs(chip.period() - 5ms), 100us);
    // That driver keeps the ratio, not the pulse, where the period is rounded.
    EXPECT_LT(std::chrono::abs(*chip.pulse(5) - chip.period() / 4), chip.period() / 4096);
    ASSERT_TRUE((*pwm)->channel(0).release());
    EXPECT_FALSE(chip.pulse(5).has_value());
  }
  put(adapter + "/delete_device", "0x41");
  EXPECT_THAT(chip.violations(), IsEmpty());
}

// And our driver on the same kernel's adapter.
struct Buses {
  mocks::SimI2cBus wires{"wires"};
  I2cBridge bridge{wires};
  std::unique_ptr<hal::I2c> bus = hal::open_i2c_dev({.device = "/dev/i2c-7", .timeout = 2s}).value();
};
class ChipRig final : Buses, public servo::Pca9685Rig {
 public:
  ChipRig() : Pca9685Rig(*bus, wires) {}
};

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(
    Kernel, PwmContract,
    testing::Values(PwmRigMaker{"Sysfs", [] { return std::make_unique<kernel::SimRig>(); }},
                    PwmRigMaker{"Pca9685", [] { return std::make_unique<kernel::ChipRig>(); }}),
    [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
