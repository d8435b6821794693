#include "hal/linux/sysfs_pwm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/virtual_clock.hpp"
#include "tests/hal/linux/fake_kernel.hpp"
#include "tests/hal/linux/fake_pwm_chip.hpp"
#include "tests/hal/pwm_contract.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SysfsPwmTest : public testing::Test {
 protected:
  Result<std::unique_ptr<SysfsPwm>> open(SysfsPwmConfig config = {.channels = {0, 1}}) {
    return open_sysfs_pwm(config, clock_, kernel_);
  }
  static ErrorCode code(const Result<std::unique_ptr<SysfsPwm>>& result) {
    return result ? ErrorCode::io : result.error().code;
  }
  fake::FakeKernel kernel_;
  mocks::VirtualClock clock_{Instant(1s)};
  fake::FakePwmChip chip_{kernel_, clock_, "pwmchip0", 2};
};

TEST_F(SysfsPwmTest, WaitsForUdevAfterTheExport) {
  const Instant before = clock_.now();
  const auto pwm = open();
  ASSERT_TRUE(pwm) << describe(pwm.error());
  EXPECT_GE(clock_.now() - before, 30ms);
  EXPECT_LE(clock_.now() - before, 50ms);
  EXPECT_EQ(2U, kernel_.open_files()) << "the locks of two channels";
}

TEST_F(SysfsPwmTest, AChannelHasOneDriver) {
  kernel_.links["/sys/class/pwm/pwmchip0"] = "../../devices/platform/soc/fe20c000.pwm/pwm/pwmchip0";
  kernel_.files["/proc/812/fd/7"] = std::make_shared<fake::Node>();
  kernel_.links["/proc/812/fd/7"] = "/sys/devices/platform/soc/fe20c000.pwm/pwm/pwmchip0/pwm0";
  {
    const auto first = open({.channels = {0}});
    ASSERT_TRUE(first) << describe(first.error());
    const auto second = open({.channels = {0}});
    EXPECT_EQ(ErrorCode::busy, code(second));
    EXPECT_THAT(describe(second.error()), HasSubstr("process 812 (?) drives this channel"));
    EXPECT_EQ(ErrorCode::busy, code(open({.channels = {1, 0}})));
    EXPECT_TRUE(open({.channels = {1}})) << "its neighbour is free";
    ASSERT_TRUE((*first)->channel(0).set_pulse(1180us));
  }
  const auto next = open({.channels = {0}});
  ASSERT_TRUE(next) << describe(next.error());
  EXPECT_EQ(1180us, (*next)->channel(0).pulse());
}

TEST_F(SysfsPwmTest, WhatRunsWithTheOtherPolarityIsSomebodyElses) {
  chip_.export_now(0);
  chip_.line(0) = {.period = 20'000'000,
                   .duty = 1'725'000,
                   .enabled = true,
                   .inversed = true,
                   .exported = true,
                   .writable_from = Instant()};
  const auto refused = open({.channels = {0}});
  EXPECT_EQ(ErrorCode::busy, code(refused));
  EXPECT_THAT(describe(refused.error()), HasSubstr("inversed"));
  EXPECT_EQ(1'725'000, chip_.line(0).duty);
  const auto inverted = open({.channels = {0}, .inverted = true});
  ASSERT_TRUE(inverted) << describe(inverted.error());
  EXPECT_EQ(1725us, (*inverted)->channel(0).pulse());
}

TEST_F(SysfsPwmTest, GivesUpOnPermissionAfterTheTimeItWasGiven) {
  chip_.udev_delay = 1h;
  const auto pwm = open({.channels = {0}, .settle = 200ms});
  EXPECT_EQ(ErrorCode::permission, code(pwm));
  EXPECT_THAT(describe(pwm.error()), HasSubstr("99-forager.rules"));
  EXPECT_LE(clock_.now() - Instant(1s), 210ms);
}

TEST_F(SysfsPwmTest, ThePulseIsSetBeforeTheOutputIsEnabled) {
  const auto pwm = open({.channels = {0}});
  kernel_.writes.clear();
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1180us));
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(1725us));
  EXPECT_THAT(kernel_.writes, ElementsAre("/sys/class/pwm/pwmchip0/pwm0/duty_cycle=1180000",
                                          "/sys/class/pwm/pwmchip0/pwm0/enable=1",
                                          "/sys/class/pwm/pwmchip0/pwm0/duty_cycle=1725000"));
}

TEST_F(SysfsPwmTest, PolarityIsSetBeforeAnythingRuns) {
  const auto pwm = open({.channels = {1}, .inverted = true});
  ASSERT_TRUE(pwm);
  EXPECT_TRUE(chip_.line(1).inversed);
  EXPECT_FALSE(chip_.line(1).enabled);
}

TEST_F(SysfsPwmTest, AChipThatCannotInvertSaysSoOnlyWhenItMust) {
  chip_.can_invert = false;
  EXPECT_TRUE(open({.channels = {0}}));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open({.channels = {1}, .inverted = true})));
}

// A servo that holds a brake must not be let go by the restart of a program.
TEST_F(SysfsPwmTest, WhatAnotherProgramLeftRunningGoesOnUntilItIsToldOtherwise) {
  chip_.export_now(0);
  chip_.line(0) = {
      .period = 10'000'000, .duty = 1'725'000, .enabled = true, .exported = true, .writable_from = Instant()};
  {
    const auto pwm = open({.channels = {0}});
    ASSERT_TRUE(pwm) << describe(pwm.error());
    EXPECT_TRUE(chip_.line(0).enabled);
    EXPECT_EQ(1725us, (*pwm)->channel(0).pulse());
    EXPECT_EQ(20'000'000, chip_.line(0).period);
    ASSERT_TRUE((*pwm)->channel(0).set_pulse(1180us));
  }
  EXPECT_TRUE(chip_.line(0).enabled);
  EXPECT_EQ(1'180'000, chip_.line(0).duty);
}

TEST_F(SysfsPwmTest, ALongerPulseThanTheNewPeriodIsNoObstacle) {
  chip_.export_now(0);
  chip_.line(0) = {.period = 100'000'000, .duty = 90'000'000, .exported = true, .writable_from = Instant()};
  const auto pwm = open({.channels = {0}});
  ASSERT_TRUE(pwm) << describe(pwm.error());
  EXPECT_EQ(20'000'000, chip_.line(0).period);
}

TEST_F(SysfsPwmTest, FindsTheChipByItsDevice) {
  kernel_.links["/sys/class/pwm/pwmchip0/device"] = "../../../fe20c000.pwm";
  EXPECT_TRUE(open({.chip = "fe20c000.pwm", .channels = {0}}));
  EXPECT_EQ(ErrorCode::not_present, code(open({.chip = "20c000.pwm", .channels = {0}})));
}

TEST_F(SysfsPwmTest, TellsWhatIsMissingApart) {
  const auto no_chip = open({.chip = "pwmchip3", .channels = {0}});
  EXPECT_EQ(ErrorCode::not_present, code(no_chip));
  EXPECT_THAT(describe(no_chip.error()), HasSubstr("pwmchip3"));
  const auto no_channel = open({.channels = {7}});
  EXPECT_EQ(ErrorCode::not_present, code(no_channel));
  EXPECT_THAT(describe(no_channel.error()), HasSubstr("pwmchip0/7"));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open({.channels = {}})));
  EXPECT_EQ(ErrorCode::invalid_argument, code(open({.channels = {0}, .period = 0s})));
  chip_.taken = {1};
  const auto taken = open({.channels = {1}});
  EXPECT_EQ(ErrorCode::busy, code(taken));
}

TEST_F(SysfsPwmTest, APeriodOneChannelRefusesLeavesAllAsTheyWere) {
  const auto pwm = open();
  ASSERT_TRUE(pwm);
  EXPECT_EQ(ErrorCode::invalid_argument, (*pwm)->set_period(500ns).error().code);
  EXPECT_EQ(20'000'000, chip_.line(0).period);
  EXPECT_EQ(20'000'000, chip_.line(1).period);
  EXPECT_EQ(20ms, (*pwm)->period());
}

TEST_F(SysfsPwmTest, LongPeriodsAreSixtyFourBitsWide) {
  const auto pwm = open({.channels = {0}});
  ASSERT_TRUE((*pwm)->set_period(3s));  // above 2^31 ns
  ASSERT_TRUE((*pwm)->channel(0).set_pulse(2500ms));
  EXPECT_EQ(2'500'000'000, chip_.line(0).duty);
}

class SysfsRig final : public contract::PwmRig {
 public:
  SysfsRig() { pwm_ = open_sysfs_pwm({.channels = {0, 1}}, clock_, kernel_).value(); }
  PwmGroup& group() override { return *pwm_; }
  PwmChannel& channel(std::size_t index) override { return pwm_->channel(index); }
  std::optional<Duration> pulse_at_pin(std::size_t index) override {
    const fake::PwmLine& line = chip_.line(index);
    return line.enabled ? std::optional(Duration(line.duty)) : std::nullopt;
  }
  Duration period_at_pin() override { return Duration(chip_.line(0).period); }
  Duration rounding() override { return 0ns; }
  void unplug(bool out) override { chip_.gone = out; }

 private:
  fake::FakeKernel kernel_;
  mocks::VirtualClock clock_;
  fake::FakePwmChip chip_{kernel_, clock_, "pwmchip0", 2};
  std::unique_ptr<SysfsPwm> pwm_;
};

}  // namespace

namespace contract {
INSTANTIATE_TEST_SUITE_P(FakeKernel, PwmContract,
                         testing::Values(PwmRigMaker{"Sysfs", [] { return std::make_unique<SysfsRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace contract
}  // namespace forager::hal
