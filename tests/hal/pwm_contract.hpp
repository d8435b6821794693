#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hal/pwm.hpp"

// The contract of hal::PwmChannel and hal::PwmGroup as tests, for every implementation alike. Include it in
// one file of a test program and instantiate PwmContract with rigs.
namespace forager::hal::contract {

// Two channels of one group, with an oscilloscope at their outputs.
class PwmRig {
 public:
  virtual ~PwmRig() = default;
  virtual PwmGroup& group() = 0;
  virtual PwmChannel& channel(std::size_t index) = 0;
  // The active part of the period at the pin, as the hardware makes it; nothing: no pulses.
  virtual std::optional<Duration> pulse_at_pin(std::size_t index) = 0;
  virtual Duration period_at_pin() = 0;
  // Half a step of the hardware at a 20 ms period: what rounding may cost.
  virtual Duration rounding() = 0;
  // Whether the timer can do periods from 3 to 20 ms.
  virtual bool can_change_period() { return true; }
  // Lets the hardware finish what it has begun.
  virtual void settle() {}
  // The hardware is unplugged, or back.
  virtual void unplug(bool out) = 0;
  virtual ErrorCode code_when_unplugged() { return ErrorCode::disconnected; }
};

struct PwmRigMaker {
  std::string name;
  std::function<std::unique_ptr<PwmRig>()> make;
};

class PwmContract : public testing::TestWithParam<PwmRigMaker> {
 protected:
  void SetUp() override { rig_->settle(); }
  PwmChannel& channel(std::size_t index) { return rig_->channel(index); }
  void expect_near(Duration wanted, std::optional<Duration> got) {
    ASSERT_TRUE(got.has_value());
    EXPECT_LE(std::chrono::abs(*got - wanted), rig_->rounding()) << got->count() << " ns";
  }
  std::unique_ptr<PwmRig> rig_ = GetParam().make();
};

using namespace std::chrono_literals;

TEST_P(PwmContract, StartsReleasedAndMakesNoPulses) {
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_FALSE(channel(i).pulse().has_value());
    EXPECT_FALSE(rig_->pulse_at_pin(i).has_value());
    EXPECT_FALSE(channel(i).name().empty());
  }
}

TEST_P(PwmContract, MakesThePulseItWasToldAndSaysWhatItReallyMakes) {
  for (const Duration pulse : {1000us, 1500us, 1180us, 2000us, 1us}) {
    ASSERT_TRUE(channel(0).set_pulse(pulse).has_value());
    rig_->settle();
    expect_near(pulse, channel(0).pulse());
    EXPECT_EQ(channel(0).pulse()->count(), rig_->pulse_at_pin(0).value_or(0ns).count());
  }
}

TEST_P(PwmContract, ChannelsOfAGroupHavePulsesOfTheirOwn) {
  ASSERT_TRUE(channel(0).set_pulse(1000us).has_value());
  ASSERT_TRUE(channel(1).set_pulse(2000us).has_value());
  rig_->settle();
  expect_near(1000us, rig_->pulse_at_pin(0));
  expect_near(2000us, rig_->pulse_at_pin(1));
  ASSERT_TRUE(channel(0).release().has_value());
  rig_->settle();
  EXPECT_FALSE(rig_->pulse_at_pin(0).has_value());
  expect_near(2000us, rig_->pulse_at_pin(1));
}

TEST_P(PwmContract, RefusesPulsesThatDoNotFitAndKeepsTheOldOne) {
  ASSERT_TRUE(channel(0).set_pulse(1500us).has_value());
  rig_->settle();
  const Duration period = rig_->group().period();
  for (const Duration bad : {Duration(-1), Duration::min(), Duration::max(), period + 1us, 2 * period})
    EXPECT_EQ(ErrorCode::invalid_argument, channel(0).set_pulse(bad).error().code) << bad.count();
  expect_near(1500us, rig_->pulse_at_pin(0));
}

TEST_P(PwmContract, AReleasedChannelStartsWithTheNewPulseOnly) {
  ASSERT_TRUE(channel(0).set_pulse(2000us).has_value());
  ASSERT_TRUE(channel(0).release().has_value());
  ASSERT_TRUE(channel(0).release().has_value());
  EXPECT_FALSE(channel(0).pulse().has_value());
  ASSERT_TRUE(channel(0).set_pulse(1000us).has_value());
  rig_->settle();
  expect_near(1000us, rig_->pulse_at_pin(0));
}

TEST_P(PwmContract, APeriodBelongsToTheGroupAndPulsesKeepTheirLength) {
  if (!rig_->can_change_period()) GTEST_SKIP() << "a fixed timer";
  ASSERT_TRUE(channel(0).set_pulse(1500us).has_value());
  ASSERT_TRUE(channel(1).set_pulse(1000us).has_value());
  rig_->settle();
  for (const Duration period : {3ms, 20ms, 10ms}) {
    ASSERT_TRUE(rig_->group().set_period(period).has_value());
    rig_->settle();
    EXPECT_EQ(rig_->group().period(), rig_->period_at_pin());
    EXPECT_LT(std::chrono::abs(rig_->group().period() - period), period / 25);
    expect_near(1500us, rig_->pulse_at_pin(0));
    expect_near(1000us, rig_->pulse_at_pin(1));
    EXPECT_EQ(*channel(0).pulse(), *rig_->pulse_at_pin(0));
  }
}

TEST_P(PwmContract, RefusesPeriodsThatAreNoneOrCutAPulse) {
  ASSERT_TRUE(channel(1).set_pulse(2000us).has_value());
  rig_->settle();
  const Duration before = rig_->group().period();
  for (const Duration bad : {0ns, Duration(-20'000'000)})
    EXPECT_EQ(ErrorCode::invalid_argument, rig_->group().set_period(bad).error().code) << bad.count();
  EXPECT_FALSE(rig_->group().set_period(1500us).has_value());
  EXPECT_EQ(before, rig_->group().period());
  expect_near(2000us, rig_->pulse_at_pin(1));
}

TEST_P(PwmContract, UnpluggedItSaysSoAndWorksAgainAfterwards) {
  ASSERT_TRUE(channel(0).set_pulse(1500us).has_value());
  rig_->settle();
  rig_->unplug(true);
  const auto lost = channel(0).set_pulse(1000us);
  ASSERT_FALSE(lost.has_value());
  EXPECT_EQ(rig_->code_when_unplugged(), lost.error().code);
  EXPECT_FALSE(lost.error().device.empty());
  EXPECT_FALSE(lost.error().operation.empty());
  rig_->unplug(false);
  ASSERT_TRUE(channel(0).set_pulse(1000us).has_value());
  rig_->settle();
  expect_near(1000us, rig_->pulse_at_pin(0));
}

}  // namespace forager::hal::contract
