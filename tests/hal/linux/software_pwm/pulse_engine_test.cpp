// Software PWM without its thread: on virtual time, exact to the nanosecond.
#include "hal/linux/pulse_engine.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "tests/hal/linux/software_pwm/stamped_line.hpp"
#include "tests/hal/pwm_contract.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;

class PulseEngineTest : public testing::Test {
 protected:
  void run_until(Instant end) {
    while (clock_.now() < end) engine_.step(clock_);
  }
  void run(Duration time) { run_until(clock_.now() + time); }

  test::LateClock clock_{Instant(1s)};
  test::StampedLine left_{"gpio left", clock_};
  test::StampedLine right_{"gpio right", clock_};
  PulseEngine engine_{"software pwm", {{&left_, 1725us}, {&right_, std::nullopt}}, 20ms, 150ms};
};

TEST_F(PulseEngineTest, PulsesBeginOnAGridThatNeverDrifts) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1500us));
  run(100ms);
  ASSERT_GE(left_.rises().size(), 5U);
  for (std::size_t i = 0; i < left_.rises().size(); ++i)
    EXPECT_EQ(left_.rises()[i], Instant(1s) + static_cast<int>(i) * 20ms);
  EXPECT_EQ(left_.last_pulse(), 1500us);
}

TEST_F(PulseEngineTest, ALateStartMakesNoShortPulseAndIsMeasured) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1500us));
  run_until(Instant(1s) + 21500us);
  clock_.late_once(3ms);  // somebody else has the processor
  run_until(Instant(1s) + 44500us);
  EXPECT_EQ(left_.rises().back() - Instant(1s), 43ms);
  EXPECT_EQ(left_.last_pulse(), 1500us);
  EXPECT_EQ(engine_.start_jitter().max(), 3ms);
  EXPECT_EQ(engine_.pulse_jitter().max(), 0ms);
  run_until(Instant(1s) + 60ms);
  EXPECT_EQ(left_.rises().back() - Instant(1s), 60ms) << "back on the grid";
}

TEST_F(PulseEngineTest, ALateEndMakesTheOnePulseLongerAndIsMeasured) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1500us));
  run_until(Instant(1s) + 20ms);
  clock_.late_once(700us);
  run_until(Instant(1s) + 22ms);
  EXPECT_EQ(left_.last_pulse(), 2200us);
  EXPECT_EQ(engine_.pulse_jitter().max(), 700us);
  EXPECT_EQ(engine_.pulse_jitter().count(), 2U);
}

TEST_F(PulseEngineTest, PeriodsThatWereSleptThroughAreNotMadeUpFor) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1500us));
  run_until(Instant(1s) + 21500us);
  clock_.advance(100ms);  // at 121.5 ms: those of 40 to 120 ms are past
  engine_.feed(clock_.now());
  run(60ms);
  EXPECT_EQ(engine_.missed_periods(), 5U);
  ASSERT_GE(left_.rises().size(), 4U);
  EXPECT_EQ(left_.rises()[1] - Instant(1s), 20ms);
  EXPECT_EQ(left_.rises()[2] - Instant(1s), 140ms);
  EXPECT_EQ(left_.rises()[3] - Instant(1s), 160ms);
}

TEST_F(PulseEngineTest, AHangOfWhoeverCommandsLocksTheOneAndLetsTheOtherGo) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1180us));
  ASSERT_TRUE(engine_.channel(1).set_pulse(1180us));
  run(140ms);
  EXPECT_EQ(left_.last_pulse(), 1180us);
  const std::size_t pulses = right_.rises().size();
  run(60ms);
  EXPECT_EQ(left_.last_pulse(), 1725us);
  EXPECT_LE(right_.rises().size(), pulses + 1U);
  const std::size_t ended = right_.rises().size();
  run(200ms);
  EXPECT_EQ(right_.rises().size(), ended);
  engine_.feed(clock_.now());
  run(40ms);
  EXPECT_EQ(left_.last_pulse(), 1180us) << "it lives again, and its command stands";
}

TEST_F(PulseEngineTest, AReleasedChannelIsNeverStale) {
  run(1s);
  EXPECT_TRUE(left_.rises().empty());
}

TEST_F(PulseEngineTest, APulseAsLongAsThePeriodNeverFalls) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(20ms));
  run(100ms);
  EXPECT_EQ(left_.rises().size(), 1U);
  EXPECT_TRUE(left_.active());
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(0ns));
  run(40ms);
  EXPECT_FALSE(left_.active());
}

TEST_F(PulseEngineTest, ALineThatFailsWhileHighIsToldAgainUntilItHears) {
  engine_.feed(clock_.now());
  ASSERT_TRUE(engine_.channel(0).set_pulse(1500us));
  engine_.step(clock_);
  ASSERT_TRUE(left_.active());
  left_.unplug(true);
  run(3ms);
  EXPECT_EQ(ErrorCode::disconnected, engine_.channel(0).set_pulse(1180us).error().code);
  left_.unplug(false);
  engine_.step(clock_);
  EXPECT_FALSE(left_.active());
  EXPECT_TRUE(engine_.channel(0).set_pulse(1180us));
}

TEST(PulseEngineEnd, LeavesEveryLineInactive) {
  test::LateClock clock{Instant(1s)};
  test::StampedLine line("gpio left", clock);
  {
    PulseEngine engine("software pwm", {{&line, std::nullopt}}, 20ms);
    ASSERT_TRUE(engine.channel(0).set_pulse(1500us));
    engine.step(clock);
    ASSERT_TRUE(line.active());
  }
  EXPECT_FALSE(line.active());
}

class EngineRig final : public contract::PwmRig {
 public:
  PwmGroup& group() override { return engine_; }
  PwmChannel& channel(std::size_t index) override { return engine_.channel(index); }
  std::optional<Duration> pulse_at_pin(std::size_t index) override {
    const test::StampedLine& line = index == 0 ? left_ : right_;
    const bool pulses = !line.rises().empty() && clock_.now() - line.rises().back() <= 2 * engine_.period();
    return pulses ? std::optional(line.last_pulse()) : std::nullopt;
  }
  Duration period_at_pin() override {
    const auto& rises = left_.rises();
    return rises.size() < 2 ? Duration{} : rises.back() - rises[rises.size() - 2];
  }
  Duration rounding() override { return Duration::zero(); }
  // Several periods: a new one counts from the end of the one that runs.
  void settle() override {
    for (const Instant end = clock_.now() + 100ms; clock_.now() < end;) engine_.step(clock_);
  }
  void unplug(bool out) override {
    left_.unplug(out);
    right_.unplug(out);
    settle();  // a failure is noticed by the edge it prevents
  }

 private:
  test::LateClock clock_{Instant(1s)};
  test::StampedLine left_{"gpio left", clock_};
  test::StampedLine right_{"gpio right", clock_};
  PulseEngine engine_{"software pwm", {{&left_, std::nullopt}, {&right_, std::nullopt}}, 20ms};
};

}  // namespace

namespace contract {
namespace {

INSTANTIATE_TEST_SUITE_P(Software, PwmContract,
                         testing::Values(PwmRigMaker{"SoftwarePwm",
                                                     [] { return std::make_unique<EngineRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

}  // namespace
}  // namespace contract
}  // namespace forager::hal
