// What the pair does while its brakes do what they are told.
#include "servo/brakes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "mocks/fake_pwm.hpp"
#include "servo/pwm_brake.hpp"
#include "tests/reader/allocation_count.hpp"
#include "tests/servo/brakes_rig.hpp"

namespace forager::servo {
namespace {

// An output that keeps its pulse and nothing else.
class PlainChannel final : public hal::PwmChannel {
 public:
  std::uint32_t sets = 0;

 private:
  hal::Result<> do_set_pulse(hal::Duration length) override {
    pulse_ = length;
    ++sets;
    return {};
  }
  hal::Result<> do_release() override {
    pulse_.reset();
    return {};
  }
  [[nodiscard]] std::optional<hal::Duration> do_pulse() const override { return pulse_; }
  [[nodiscard]] std::string_view do_name() const override { return "plain"; }
  std::optional<hal::Duration> pulse_;
};

TEST_F(Brakes, AreLockedFromConstructionOnAndAllowNoThrust) {
  EXPECT_TRUE(left_locked() && right_locked());
  run(1s);
  EXPECT_TRUE(left_locked() && right_locked());
  EXPECT_FALSE(brakes_->thrust_allowed());
  EXPECT_EQ(BrakeState::engaged, brakes_->state());
}

TEST_F(Brakes, FollowFreshCommandsAndLockWhenTheyRunOut) {
  command(0.0, 1.0, 500ms);
  run(200ms);
  EXPECT_TRUE(left_open() && right_locked());
  EXPECT_TRUE(brakes_->thrust_allowed());
  run(500ms);
  EXPECT_TRUE(left_locked() && right_locked());
  EXPECT_EQ(BrakeState::engaged, brakes_->state());
  EXPECT_FALSE(brakes_->thrust_allowed());
  EXPECT_EQ(1U, journal_.count("engaged: the command ran out"));
}

TEST_F(Brakes, AreFullyLockedWithin300MillisecondsOfTheExpiry) {
  command(0.0, 0.0, 1s);
  run(980ms);
  EXPECT_TRUE(left_open() && right_open());
  run(300ms);
  EXPECT_TRUE(left_locked() && right_locked());
}

TEST_F(Brakes, NeitherExpiredNorSenselessCommandsOpenThem) {
  command(0.0, 0.0, 0s);
  run(1s);
  EXPECT_EQ(BrakeState::engaged, brakes_->state());
  command(0.0, std::nan(""));
  run(1s);
  EXPECT_TRUE(left_locked() && right_locked());
}

TEST_F(Brakes, HaltLocksWithoutWaitingForAnUpdateAndHoldsUntilResumed) {
  command(0.0, 0.0);
  run(500ms);
  brakes_->halt();
  EXPECT_TRUE(left_locked() && right_locked());
  command(0.0, 0.0);
  run(500ms);
  EXPECT_TRUE(left_locked() && right_locked());
  brakes_->resume(now_);
  run(500ms);
  EXPECT_TRUE(left_locked() && right_locked()) << "a command from before the halt must not come back";
  command(0.0, 0.0);
  run(500ms);
  EXPECT_TRUE(left_open() && right_open());
}

TEST_F(Brakes, TheEndOfTheObjectLocksThem) {
  command(0.0, 0.0);
  run(500ms);
  brakes_.reset();
  EXPECT_TRUE(left_locked() && right_locked());
}

TEST_F(Brakes, HeatIsReportedAndNeverOpensABrake) {
  run(20min);
  EXPECT_TRUE(brakes_->status().left_heat.rest_advised);
  EXPECT_GT(brakes_->status().left_heat.hot_s, 60.0);
  EXPECT_NEAR(1201.0, brakes_->status().left_heat.locked_s, 2.0);
  EXPECT_TRUE(left_locked() && right_locked());
  EXPECT_EQ(1U, journal_.count("left brake: hot or locked for long"));
}

TEST(BrakeHeat, FollowsTheFirstOrderLawWhateverTheStep) {
  BrakeHeatModel fine({.hold_rise_k = 60.0, .time_constant_s = 300.0});
  BrakeHeatModel coarse({.hold_rise_k = 60.0, .time_constant_s = 300.0});
  for (int ms = 0; ms <= 300'000; ms += 10)
    (void)fine.update(1.0, hal::Instant(std::chrono::milliseconds(ms)));
  for (int s = 0; s <= 300; s += 100) (void)coarse.update(1.0, hal::Instant(std::chrono::seconds(s)));
  EXPECT_NEAR(60.0 * (1.0 - std::exp(-1.0)), fine.state().rise_k, 1e-6);
  EXPECT_NEAR(fine.state().rise_k, coarse.state().rise_k, 1e-6);
}

// A journal that keeps nothing: what it would keep would be counted.
TEST(BrakeAllocations, FollowingCommandsAllocatesNothing) {
  hal::NullJournal journal;
  mocks::FakePwmGroup group("timer", 2);
  PwmBrake left = PwmBrake::create(group.channel(0), laboratory_left()).value();
  PwmBrake right = PwmBrake::create(group.channel(1), laboratory_right()).value();
  hal::Instant now(1s);
  BrakePair brakes(left, right, journal, BrakePairConfig{}, now);
  const auto step = [&] {
    now += 10ms;
    // Pulses are kept by the fake timer whenever they change: these do not.
    brakes.command({1.0, 1.0, now + 100ms});
    brakes.observe({0.0, 0.0, now});
    brakes.update(now);
  };
  for (int i = 0; i < 100; ++i) step();
  ASSERT_EQ(BrakeState::following, brakes.state());
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 1000; ++i) step();
  EXPECT_EQ(test::allocation_count(), before);
}

// The same with pulses that move at every step, on outputs that keep no record.
TEST(BrakeAllocations, MovingThemAllocatesNothing) {
  hal::NullJournal journal;
  PlainChannel left_channel;
  PlainChannel right_channel;
  PwmBrake left = PwmBrake::create(left_channel, laboratory_left()).value();
  PwmBrake right = PwmBrake::create(right_channel, laboratory_right()).value();
  hal::Instant now(1s);
  BrakePair brakes(left, right, journal, BrakePairConfig{}, now);
  const auto step = [&](int i) {
    now += 10ms;
    const double to = (i / 20) % 2 == 0 ? 0.0 : 1.0;
    brakes.command({to, 1.0 - to, now + 100ms});
    brakes.update(now);
  };
  for (int i = 0; i < 100; ++i) step(i);
  ASSERT_EQ(BrakeState::following, brakes.state());
  const std::uint64_t before = test::allocation_count();
  const std::uint32_t moved = left_channel.sets + right_channel.sets;
  for (int i = 0; i < 1000; ++i) step(i);
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_GT(left_channel.sets + right_channel.sets, moved + 500U);
}

}  // namespace
}  // namespace forager::servo
