#include "flight/mavlink_servos.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "servo/pwm_brake.hpp"
#include "tests/flight/mavlink_bench_autopilot.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::AutopilotBench;
using testing::HasSubstr;

constexpr std::uint16_t kDoSetServo = 183;  // MAVLink common.xml
constexpr std::uint8_t kAccepted = 0;
constexpr std::uint8_t kFailed = 4;

class AutopilotOutputs : public testing::Test {
 protected:
  AutopilotOutputs() { bench_.connect(); }
  hal::PwmChannel& output(std::size_t number) { return bench_.ours().servos().output(number); }
  // What came since the last call, as "output=us".
  std::vector<std::string> came() {
    std::vector<std::string> list;
    for (const auto& frame : bench_.commands(kDoSetServo))
      list.push_back(std::to_string(static_cast<int>(frame.payload.f32(0))) + "=" +
                     std::to_string(static_cast<int>(frame.payload.f32(4))));
    bench_.clear();
    return list;
  }
  void answer(std::uint8_t result = kAccepted) {
    bench_.send_ack(kDoSetServo, result);
    bench_.step();
  }
  AutopilotBench bench_;
};

TEST_F(AutopilotOutputs, SendsOneCommandAtATimeAndTheNextAfterItsAnswer) {
  EXPECT_FALSE(output(9).pulse().has_value());
  ASSERT_TRUE(output(9).set_pulse(1180us));
  ASSERT_TRUE(output(10).set_pulse(1875us));
  bench_.step();
  EXPECT_THAT(came(), testing::ElementsAre("9=1180"));
  answer();
  EXPECT_THAT(came(), testing::ElementsAre("10=1875"));
  answer();
  EXPECT_THAT(came(), testing::IsEmpty());
  EXPECT_EQ(1875us, output(10).pulse());
}

TEST_F(AutopilotOutputs, ARepeatCarriesTheNewestPulse) {
  ASSERT_TRUE(output(9).set_pulse(1180us));
  bench_.step();
  ASSERT_TRUE(output(9).set_pulse(1725us));
  bench_.run(200ms);
  EXPECT_THAT(came(), testing::ElementsAre("9=1180", "9=1725"));
  answer();
  EXPECT_THAT(came(), testing::IsEmpty());
}

TEST_F(AutopilotOutputs, ARefusalShowsAtTheNextSetWithItsMend) {
  ASSERT_TRUE(output(3).set_pulse(1500us));
  bench_.step();
  answer(kFailed);
  const auto refused = output(3).set_pulse(1500us);
  ASSERT_FALSE(refused);
  EXPECT_EQ(hal::ErrorCode::refused, refused.error().code);
  EXPECT_THAT(describe(refused.error()), HasSubstr("SERVO3_FUNCTION"));
}

TEST_F(AutopilotOutputs, SilenceShowsAsATimeOut) {
  ASSERT_TRUE(output(9).set_pulse(1500us));
  bench_.run(1500ms);
  EXPECT_EQ(hal::ErrorCode::timeout, output(9).set_pulse(1500us).error().code);
}

TEST_F(AutopilotOutputs, EveryOutputIsToldAgainForAnAutopilotThatForgot) {
  ASSERT_TRUE(output(9).set_pulse(1725us));
  bench_.step();
  answer();
  (void)came();
  int told = 0;
  for (int i = 0; i < 60; ++i) {
    bench_.step();
    for (const auto& command : came()) told += command == "9=1725" ? 1 : 0;
    bench_.send_ack(kDoSetServo, kAccepted);
  }
  EXPECT_GE(told, 2);
  EXPECT_LE(told, 3);
}

TEST_F(AutopilotOutputs, WithoutALinkNothingIsTaken) {
  bench_.heartbeats(false);
  bench_.run(5s);
  (void)came();
  EXPECT_EQ(hal::ErrorCode::disconnected, output(9).set_pulse(1180us).error().code);
  bench_.run(2s);
  EXPECT_THAT(came(), testing::IsEmpty());
}

TEST_F(AutopilotOutputs, WhatWasWantedLastIsWhatComesWhenTheLinkIsBack) {
  ASSERT_TRUE(output(9).set_pulse(1180us));  // open
  bench_.step();
  answer();
  bench_.heartbeats(false);
  bench_.run(5s);
  (void)came();
  EXPECT_EQ(hal::ErrorCode::disconnected, output(9).set_pulse(1725us).error().code);  // lock
  bench_.heartbeats(true);
  bench_.run(1200ms);
  const auto told = came();
  ASSERT_FALSE(told.empty());
  for (const auto& command : told)
    EXPECT_EQ(command, "9=1725") << "an open brake must not come out of the past";
}

TEST_F(AutopilotOutputs, ALostCommandDoesNotKeepTheOtherBrakeWaiting) {
  ASSERT_TRUE(output(9).set_pulse(1725us));
  ASSERT_TRUE(output(10).set_pulse(1875us));
  bench_.run(140ms);  // no answer to the first
  EXPECT_THAT(came(), testing::ElementsAre("9=1725", "10=1875"));
  answer();  // to one of them: the newer
  bench_.run(200ms);
  EXPECT_THAT(came(), testing::ElementsAre("9=1725")) << "the older is told again";
  answer();
  bench_.run(200ms);
  EXPECT_THAT(came(), testing::IsEmpty());
}

TEST_F(AutopilotOutputs, ARefusalThatMayBeOfEitherIsBlamedOnNeither) {
  ASSERT_TRUE(output(9).set_pulse(1725us));
  ASSERT_TRUE(output(10).set_pulse(1875us));
  bench_.run(140ms);
  answer(kFailed);
  EXPECT_TRUE(output(9).set_pulse(1725us));
  EXPECT_TRUE(output(10).set_pulse(1875us));
}

TEST_F(AutopilotOutputs, RefusesPulsesNoServoKnows) {
  for (const hal::Duration bad : {hal::Duration(-1), hal::Duration(3001us), hal::Duration::max()})
    EXPECT_EQ(hal::ErrorCode::invalid_argument, output(9).set_pulse(bad).error().code);
  ASSERT_TRUE(output(9).release());
  bench_.step();
  EXPECT_THAT(came(), testing::ElementsAre("9=0"));
}

TEST_F(AutopilotOutputs, DriveABrakeLikeAnyOtherChannel) {
  auto brake = servo::PwmBrake::create(output(9), servo::laboratory_left());
  ASSERT_TRUE(brake);
  brake->halt();
  bench_.step();
  EXPECT_THAT(came(), testing::ElementsAre("9=1725"));
}

}  // namespace
}  // namespace forager::flight
