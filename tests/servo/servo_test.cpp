#include "servo/servo.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "mocks/fake_pwm.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

hal::Instant at(hal::Duration t) { return hal::Instant(t); }

class ServoTest : public testing::Test {
 protected:
  Servo servo(ServoConfig config) {
    return Servo::create(group_.channel(0), PulseMap::between({0.0, 1000us}, {1.0, 2000us}).value(), config)
        .value();
  }
  std::string refusal(ServoConfig config) {
    const auto made =
        Servo::create(group_.channel(0), PulseMap::between({0.0, 1000us}, {1.0, 2000us}).value(), config);
    return made ? std::string("accepted") : made.error().detail;
  }
  mocks::FakePwmGroup group_{"timer", 1};
  mocks::FakePwmChannel& channel_ = group_.channel(0);
};

TEST_F(ServoTest, ConstructionSendsNothingAndTheFirstCommandDoesNotJump) {
  Servo it = servo({.safe = 0.0, .slew_per_s = 2.0});
  EXPECT_EQ(0U, channel_.calls());
  ASSERT_TRUE(it.move(1.0, at(5s)));
  EXPECT_EQ(1000us, channel_.pulse().value());  // where it is taken to be
  ASSERT_TRUE(it.move(1.0, at(5s + 50ms)));
  EXPECT_EQ(1100us, channel_.pulse().value());
}

TEST_F(ServoTest, AfterALongPauseItStartsNoFasterThanItsLimit) {
  Servo it = servo({.safe = 0.0, .slew_per_s = 2.0, .longest_step = 100ms});
  ASSERT_TRUE(it.move(0.0, at(0s)));
  ASSERT_TRUE(it.move(1.0, at(60s)));
  EXPECT_EQ(1200us, channel_.pulse().value());
}

RC_GTEST_FIXTURE_PROP(ServoTest, NoSequenceOfCommandsExceedsSlewOrStops, ()) {
  Servo it = servo({.safe = 0.5, .slew_per_s = 3.0, .trim = 150us, .min_pulse = 1100us, .max_pulse = 1900us});
  const auto targets = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-500, 1500));
  hal::Instant now = at(1s);
  double place = it.place();
  for (const int target : targets) {
    const hal::Duration step(*rc::gen::inRange(0, 150'000'000));
    now += step;
    RC_ASSERT(it.move(target / 1000.0, now).has_value());
    const double limit = 3.0 * std::min(0.1, hal::to_seconds(step));
    RC_ASSERT(std::abs(it.place() - place) <= limit + 1e-12);
    RC_ASSERT(channel_.pulse() >= 1100us && channel_.pulse() <= 1900us);
    place = it.place();
  }
}

TEST_F(ServoTest, TrimShiftsThePulseAndTheStopsHold) {
  Servo it = servo({.safe = 0.5, .trim = 30us, .min_pulse = 1100us, .max_pulse = 1900us});
  ASSERT_TRUE(it.jump(0.5, at(0s)));
  EXPECT_EQ(1530us, channel_.pulse().value());
  ASSERT_TRUE(it.jump(1.0, at(0s)));
  EXPECT_EQ(1900us, channel_.pulse().value());
  ASSERT_TRUE(it.jump(0.0, at(0s)));
  EXPECT_EQ(1100us, channel_.pulse().value());
}

TEST_F(ServoTest, WhatIsNoNumberMovesNothing) {
  Servo it = servo({.safe = 0.5});
  ASSERT_TRUE(it.jump(0.25, at(0s)));
  EXPECT_EQ(hal::ErrorCode::invalid_argument, it.move(std::nan(""), at(1s)).error().code);
  EXPECT_EQ(hal::ErrorCode::invalid_argument, it.jump(std::nan(""), at(1s)).error().code);
  EXPECT_EQ(1250us, channel_.pulse().value());
}

TEST_F(ServoTest, AnUnchangedPulseIsSentOnceInItsTimeAndAFailedOneAgain) {
  Servo it = servo({.safe = 0.0, .refresh = 500ms});
  ASSERT_TRUE(it.jump(0.5, at(0s)));
  ASSERT_TRUE(it.jump(0.5, at(400ms)));
  EXPECT_EQ(1U, channel_.calls());
  channel_.fail_next({hal::ErrorCode::no_ack, "chip", "write", "no answer", ""});
  EXPECT_EQ(hal::ErrorCode::no_ack, it.jump(1.0, at(420ms)).error().code);
  EXPECT_DOUBLE_EQ(0.5, it.place());
  ASSERT_TRUE(it.jump(0.5, at(440ms)));  // the output is unknown after a failure: told again
  EXPECT_EQ(2U, channel_.calls());
  ASSERT_TRUE(it.jump(0.5, at(939ms)));
  EXPECT_EQ(2U, channel_.calls());
  ASSERT_TRUE(it.jump(0.5, at(940ms)));
  EXPECT_EQ(3U, channel_.calls());
}

TEST_F(ServoTest, HaltGoesToTheSafePlaceAtOnceAndHolds) {
  Servo it = servo({.safe = 1.0, .slew_per_s = 0.1, .at_halt = AtHalt::hold});
  ASSERT_TRUE(it.jump(0.0, at(0s)));
  it.halt();
  EXPECT_EQ(2000us, channel_.pulse().value());
  it.halt();  // an output may have lost it: said again
  EXPECT_EQ(3U, channel_.calls());
}

TEST_F(ServoTest, HaltMayReleaseAfterwards) {
  Servo it = servo({.safe = 1.0, .at_halt = AtHalt::release});
  ASSERT_TRUE(it.jump(0.0, at(0s)));
  it.halt();
  EXPECT_EQ(2000us, channel_.pulse().value());
  ASSERT_TRUE(it.move(1.0, at(100ms)));
  ASSERT_TRUE(it.move(1.0, at(399ms)));
  EXPECT_EQ(2000us, channel_.pulse().value()) << "it has to get there first";
  ASSERT_TRUE(it.move(1.0, at(400ms)));
  EXPECT_FALSE(channel_.pulse().has_value());
  ASSERT_TRUE(it.jump(1.0, at(1s)));
  EXPECT_EQ(2000us, channel_.pulse().value());
}

TEST_F(ServoTest, HaltOnABrokenCableIsQuiet) {
  Servo it = servo({.safe = 1.0});
  channel_.disconnect();
  it.halt();
  channel_.disconnect(false);
  it.halt();
  EXPECT_EQ(2000us, channel_.pulse().value());
}

TEST_F(ServoTest, RefusesConfigurationsThatCannotMove) {
  EXPECT_THAT(refusal({.slew_per_s = 0.0}), HasSubstr("slew"));
  EXPECT_THAT(refusal({.slew_per_s = std::nan("")}), HasSubstr("slew"));
  EXPECT_THAT(refusal({.safe = 1.5}), HasSubstr("safe place"));
  EXPECT_THAT(refusal({.safe = std::nan("")}), HasSubstr("safe place"));
  EXPECT_THAT(refusal({.min_pulse = 2000us, .max_pulse = 2500us}), HasSubstr("leave nothing"));
  EXPECT_THAT(refusal({.trim = 2ms}), HasSubstr("leave nothing"));
  EXPECT_THAT(refusal({.min_pulse = 1500us, .max_pulse = 1500us}), HasSubstr("leave nothing"));
}

}  // namespace
}  // namespace forager::servo
