// What a brake is told when nothing changes: outputs lose what they were told, and a stop must not wait.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "mocks/fake_digital_out.hpp"
#include "mocks/fake_modbus.hpp"
#include "mocks/fake_pwm.hpp"
#include "mocks/text_journal.hpp"
#include "servo/brakes.hpp"
#include "servo/digital_brake.hpp"
#include "servo/modbus_brake.hpp"
#include "servo/pwm_brake.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;

const ModbusBrakeConfig kActuator{
    .unit = 3, .target = {.address = 40}, .open_value = 900, .locked_value = 100, .enable_coil = 1};

class BrakesToldAgain : public testing::Test {
 protected:
  BrakesToldAgain() {
    bus_.holding[40] = 0;
    bus_.coils[1] = false;
  }
  void hold(BrakeActuator& brake, double fraction, hal::Duration time) {
    for (const hal::Instant end = now_ + time; now_ < end; now_ += 20ms)
      ASSERT_TRUE(brake.move(fraction, now_));
  }
  void run(BrakePair& pair, hal::Duration time, std::optional<VehicleMotion> motion = {}) {
    for (const hal::Instant end = now_ + time; now_ < end;) {
      now_ += 20ms;
      if (motion) pair.observe({motion->forward_m_s, motion->yaw_rate_rad_s, now_});
      pair.update(now_);
    }
  }

  hal::Instant now_{1s};
  mocks::TextJournal journal_;
  mocks::FakePwmGroup group_{"timer", 2};
  mocks::FakeModbus bus_{3};
  mocks::FakeDigitalOut line_{"relay"};
};

TEST_F(BrakesToldAgain, AnActuatorThatLostItsSupplyForAMomentIsToldWithinASecond) {
  ModbusBrake brake = ModbusBrake::create(bus_, kActuator).value();
  hold(brake, 1.0, 1s);
  bus_.holding[40] = 900;  // it woke open, and switched off
  bus_.coils[1] = false;
  hold(brake, 1.0, 600ms);
  EXPECT_EQ(bus_.holding[40], 100);
  EXPECT_TRUE(bus_.coils[1]);
}

TEST_F(BrakesToldAgain, AServoHearsItsPulseAgainTwiceASecondAndNoMore) {
  PwmBrake brake = PwmBrake::create(group_.channel(0), laboratory_left()).value();
  brake.halt();
  hold(brake, 1.0, 100ms);
  const std::uint32_t before = group_.channel(0).calls();
  hold(brake, 1.0, 2s);
  EXPECT_GE(group_.channel(0).calls() - before, 3U);
  EXPECT_LE(group_.channel(0).calls() - before, 5U);
}

TEST_F(BrakesToldAgain, ALineIsSetAgainTwiceASecond) {
  DigitalBrake brake(line_, WhenActive::locks);
  hold(brake, 1.0, 100ms);
  const std::uint32_t before = line_.sets();
  hold(brake, 1.0, 2s);
  EXPECT_GE(line_.sets() - before, 3U);
  EXPECT_LE(line_.sets() - before, 5U);
}

TEST_F(BrakesToldAgain, AnOutputThatFailsWhileNothingChangesIsFound) {
  PwmBrake left = PwmBrake::create(group_.channel(0), laboratory_left()).value();
  PwmBrake right = PwmBrake::create(group_.channel(1), laboratory_right()).value();
  BrakePair pair(left, right, journal_, {}, now_);
  pair.command({0.0, 0.0, now_ + 10s});
  run(pair, 1s);
  group_.channel(0).disconnect();
  run(pair, 600ms);
  EXPECT_EQ(pair.status().left.kind, BrakeFaultKind::output);
}

TEST_F(BrakesToldAgain, ABadBrakeIsToldToLockAgainAndAgain) {
  ModbusBrake left = ModbusBrake::create(bus_, kActuator).value();
  PwmBrake right = PwmBrake::create(group_.channel(0), laboratory_right()).value();
  BrakePair pair(left, right, journal_, {}, now_);
  pair.command({1.0, 1.0, now_ + 1min});
  run(pair, 2s, VehicleMotion{0.8, 0.0, {}});  // it slides, whatever it is told
  ASSERT_EQ(pair.state(), BrakeState::faulted);
  for (int times = 0; times < 10; ++times) {
    bus_.holding[40] = 900;
    run(pair, 100ms);
    EXPECT_EQ(bus_.holding[40], 100) << times;
  }
}

TEST_F(BrakesToldAgain, AfterAFaultWasClearedNothingIsTakenAsKnown) {
  DigitalBrake left(line_, WhenActive::locks);
  PwmBrake right = PwmBrake::create(group_.channel(0), laboratory_right()).value();
  BrakePair pair(left, right, journal_, {}, now_);
  pair.command({1.0, 1.0, now_ + 1min});
  run(pair, 2s, VehicleMotion{0.8, 0.0, {}});
  ASSERT_EQ(pair.state(), BrakeState::faulted);
  const std::uint32_t left_before = line_.sets();
  const std::uint32_t right_before = group_.channel(0).calls();
  ASSERT_TRUE(pair.clear_fault(now_));
  run(pair, 20ms);
  EXPECT_GT(line_.sets(), left_before);
  EXPECT_GT(group_.channel(0).calls(), right_before);
}

TEST_F(BrakesToldAgain, TheGoodBrakeLocksInTheUpdateThatFindsTheOtherOneBad) {
  PwmBrake left = PwmBrake::create(group_.channel(0), laboratory_left()).value();
  PwmBrake right = PwmBrake::create(group_.channel(1), laboratory_right()).value();
  for (const bool left_fails : {true, false}) {
    BrakePair pair(left, right, journal_, {}, now_);
    pair.command({0.0, 0.0, now_ + 10s});
    run(pair, 500ms, VehicleMotion{0.8, 0.0, {}});
    group_.channel(left_fails ? 0 : 1).disconnect();
    pair.command({left_fails ? 1.0 : 0.0, left_fails ? 0.0 : 1.0, now_ + 10s});
    run(pair, 20ms, VehicleMotion{0.8, 0.0, {}});
    ASSERT_EQ(pair.state(), BrakeState::faulted);
    if (left_fails)
      EXPECT_EQ(group_.channel(1).pulse(), 1875us);
    else
      EXPECT_EQ(group_.channel(0).pulse(), 1725us);
    group_.channel(left_fails ? 0 : 1).disconnect(false);
  }
}

TEST_F(BrakesToldAgain, APoseFromTheFutureTellsNothingOfTheWheels) {
  PwmBrake left = PwmBrake::create(group_.channel(0), laboratory_left()).value();
  PwmBrake right = PwmBrake::create(group_.channel(1), laboratory_right()).value();
  BrakePair pair(left, right, journal_, {}, now_);
  pair.command({1.0, 1.0, now_ + 1min});
  pair.observe({0.8, 0.0, now_ + 5s});  // would look fresh for five seconds
  run(pair, 3s);
  EXPECT_EQ(pair.state(), BrakeState::following);
}

class ReleaseAtHalt : public BrakesToldAgain {
 protected:
  static PwmBrakeConfig config() {
    PwmBrakeConfig c = laboratory_left();
    c.at_halt = AtHalt::release;
    return c;
  }
  PwmBrake brake_ = PwmBrake::create(group_.channel(0), config()).value();
};

TEST_F(ReleaseAtHalt, TheServoGetsTimeToLockBeforeItsPulsesEnd) {
  hold(brake_, 0.0, 500ms);
  brake_.halt();
  EXPECT_EQ(group_.channel(0).pulse(), 1725us);
  hold(brake_, 1.0, 280ms);
  EXPECT_EQ(group_.channel(0).pulse(), 1725us) << "a servo needs its frames to get there";
  hold(brake_, 1.0, 100ms);
  EXPECT_FALSE(group_.channel(0).pulse());
  hold(brake_, 1.0, 3s);
  EXPECT_FALSE(group_.channel(0).pulse()) << "released means released";
}

TEST_F(ReleaseAtHalt, ItMovesAgainWhenItIsToldTo) {
  hold(brake_, 0.0, 500ms);
  brake_.halt();
  hold(brake_, 1.0, 1s);
  ASSERT_FALSE(group_.channel(0).pulse());
  hold(brake_, 0.0, 500ms);
  EXPECT_EQ(group_.channel(0).pulse(), 1180us);
}

TEST_F(ReleaseAtHalt, AMoveBeforeTheTimeIsUpKeepsThePulses) {
  hold(brake_, 0.0, 500ms);
  brake_.halt();
  hold(brake_, 1.0, 100ms);
  hold(brake_, 0.0, 500ms);
  EXPECT_EQ(group_.channel(0).pulse(), 1180us);
}

}  // namespace
}  // namespace forager::servo
