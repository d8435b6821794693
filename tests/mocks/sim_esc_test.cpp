#include "mocks/sim_esc.hpp"

#include <gtest/gtest.h>

#include "mocks/fake_pwm.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

class SimEscTest : public ::testing::Test {
 protected:
  // Pulses of one length, one a period.
  void send(hal::Duration length, int count) {
    for (int i = 0; i < count; ++i) esc.pulse(length, now += period);
  }
  void silence(hal::Duration time) { esc.update(now += time); }
  void wake() {
    esc.set_power(true, now);
    silence(600ms);
  }

  hal::Instant now{1s};
  hal::Duration period = 20ms;
  SimEsc esc{"esc", {}};
};

TEST_F(SimEscTest, ArmsAtTheEleventhStopPulse) {
  wake();
  send(1000us, 10);
  EXPECT_EQ(esc.state(), SimEscState::waiting);
  send(1000us, 1);
  EXPECT_EQ(esc.state(), SimEscState::armed);
}

TEST_F(SimEscTest, AnyThrottlePulseStartsTheCountAnew) {
  wake();
  send(1000us, 10);
  send(1100us, 1);
  send(1000us, 10);
  EXPECT_EQ(esc.state(), SimEscState::waiting);
  send(1060us, 1);
  EXPECT_EQ(esc.state(), SimEscState::armed) << "its stop level counts as stop";
}

TEST_F(SimEscTest, HearsNothingWhileItBeeps) {
  esc.set_power(true, now);
  send(1000us, 29);
  EXPECT_EQ(esc.pulses(), 0U);
  EXPECT_EQ(esc.state(), SimEscState::beeping);
}

TEST_F(SimEscTest, HighFirstPulsesCalibrateIt) {
  wake();
  send(2000us, 32);
  EXPECT_EQ(esc.state(), SimEscState::learning_stop);
  send(1000us, 32);
  EXPECT_EQ(esc.calibrations_done(), 1U);
  EXPECT_EQ(esc.full_pulse(), 1937500ns);
  EXPECT_EQ(esc.stop_pulse(), 1062500ns);
  send(1000us, 11);
  EXPECT_EQ(esc.state(), SimEscState::armed);
}

TEST_F(SimEscTest, ALevelThatMovesIsAveragedAnew) {
  wake();
  send(2000us, 31);
  send(1985us, 31);
  EXPECT_EQ(esc.state(), SimEscState::learning_full);
  send(1985us, 1);
  EXPECT_EQ(esc.state(), SimEscState::learning_stop);
}

TEST_F(SimEscTest, HighPulsesAfterALowOneDoNotCalibrateIt) {
  wake();
  send(1000us, 1);
  send(2000us, 100);
  EXPECT_EQ(esc.calibrations_begun(), 0U);
  EXPECT_EQ(esc.drive(), 0.0);
}

TEST_F(SimEscTest, ThrowsPulsesAwayThatAreNone) {
  wake();
  send(1000us, 11);
  send(700us, 3);
  send(2401us, 3);
  EXPECT_EQ(esc.thrown_away(), 6U);
  EXPECT_EQ(esc.state(), SimEscState::armed);
}

TEST_F(SimEscTest, RunsWithThePulseAndStopsAfter131Milliseconds) {
  wake();
  send(1000us, 11);
  send(1460us, 20);
  EXPECT_NEAR(esc.drive(), 0.5, 1e-12);
  EXPECT_NEAR(esc.spin(), 0.5, 0.01);
  silence(131ms);
  EXPECT_GT(esc.drive(), 0.0);
  silence(1ms);
  EXPECT_EQ(esc.drive(), 0.0);
  send(1460us, 1);
  EXPECT_NEAR(esc.drive(), 0.5, 1e-12) << "a short silence does not disarm";
  silence(2s);
  EXPECT_EQ(esc.state(), SimEscState::waiting);
  send(1460us, 50);
  EXPECT_EQ(esc.drive(), 0.0) << "it wants the stop pulses again";
}

TEST_F(SimEscTest, FindsOneShotOutByItself) {
  period = 500us;
  wake();
  send(125us, 11);
  EXPECT_TRUE(esc.oneshot());
  EXPECT_EQ(esc.state(), SimEscState::armed);
  send(182500ns, 2000);
  EXPECT_NEAR(esc.spin(), 0.5, 0.01);
}

TEST(SimEscWire, MakesOnePulseAPeriod) {
  FakePwmGroup group("timer", 1, 2500us);
  SimEsc esc("esc", {});
  SimEscWire wire(group.channel(0), group, esc);
  hal::Instant now{1s};
  esc.set_power(true, now);
  esc.update(now += 700ms);
  wire.update(now += 1s);
  EXPECT_EQ(esc.pulses(), 0U) << "released: no pulses";
  ASSERT_TRUE(group.channel(0).set_pulse(1000us));
  for (int i = 0; i <= 100; ++i) wire.update(now += 1ms);
  EXPECT_EQ(esc.pulses(), 40U);
  wire.cut(true);
  for (int i = 0; i <= 100; ++i) wire.update(now += 1ms);
  EXPECT_EQ(esc.pulses(), 40U);
}

}  // namespace
}  // namespace forager::mocks
