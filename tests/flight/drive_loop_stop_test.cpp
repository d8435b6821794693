// How the drive loop ends: who has the vehicle, what is sent when, and what it goes by until it stands.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/flight/drive_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::DriveRig;

auto stops(const DriveRig& rig) { return std::ranges::count(rig.autopilot.asked, "stop"); }

TEST(DriveLoopStop, RollsToItsGoalAndDisarms) {
  DriveRig rig;
  ASSERT_TRUE(rig.run_until(DrivePhase::driving));
  rig.run(60s);
  EXPECT_EQ(rig.loop.status().end, DriveEnd::arrived) << rig.loop.status().detail;
  EXPECT_NEAR(rig.camera.body.position.x, 3.0, 0.15);
  EXPECT_FALSE(rig.autopilot.said.armed);
}

TEST(DriveLoopStop, WhatItDecidesGoesOutInTheSameUpdate) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  while (rig.thrust() == 0.0) rig.tick();
  rig.commands = false;
  rig.loop.go(rig.now);  // the mission takes its command back
  rig.tick();
  EXPECT_EQ(rig.thrust(), 0.0) << "brakes and thrust, not the brakes first";
  EXPECT_EQ(rig.left.pressed() + rig.right.pressed(), 2.0);
}

TEST(DriveLoopStop, APilotGetsTheVehicleWithoutAPushInForce) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  while (rig.thrust() == 0.0) rig.tick();
  rig.autopilot.said.guided = false;
  rig.tick();
  EXPECT_EQ(rig.loop.status().end, DriveEnd::pilot);
  EXPECT_FALSE(rig.autopilot.in_force);
  EXPECT_EQ(stops(rig), 0);
}

TEST(DriveLoopStop, APilotWhoTakesItWhileItStopsKeepsIt) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  rig.autopilot.answers = false;
  rig.loop.halt();
  rig.tick();
  ASSERT_EQ(rig.loop.status().phase, DrivePhase::stopping);
  ASSERT_EQ(stops(rig), 1);
  rig.autopilot.said.guided = false;  // and flies away
  rig.run(5s);
  EXPECT_EQ(rig.loop.status().end, DriveEnd::pilot);
  EXPECT_EQ(rig.autopilot.request_state(), RequestState::none) << "nothing is repeated to him";
  EXPECT_EQ(stops(rig), 1);
  EXPECT_TRUE(rig.loop.done());
}

TEST(DriveLoopStop, HaltLeavesAPilotsVehicleAlone) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  rig.autopilot.said.guided = false;
  rig.run(1s);
  ASSERT_EQ(rig.loop.status().end, DriveEnd::pilot);
  rig.loop.halt();
  EXPECT_EQ(rig.autopilot.halts, 0);
}

TEST(DriveLoopStop, WhatWasArmedForUsIsNotLeftToAPilotWhoTookItMeanwhile) {
  DriveRig rig;
  ASSERT_TRUE(rig.run_until(DrivePhase::guided));
  rig.tick();
  rig.autopilot.answers = false;
  ASSERT_TRUE(rig.run_until(DrivePhase::arming));
  rig.autopilot.said.guided = false;
  rig.tick();
  EXPECT_EQ(rig.loop.status().end, DriveEnd::pilot);
  EXPECT_EQ(rig.autopilot.asked.back(), "disarm") << "not forced: an autopilot that flies refuses it";
  rig.autopilot.said.armed = true;  // the arming had been on its way
  rig.autopilot.answers = true;
  rig.run(1s);
  EXPECT_FALSE(rig.autopilot.said.armed);
  EXPECT_TRUE(rig.loop.done());
}

TEST(DriveLoopStop, OnePoseOfTheFutureDoesNotKeepItBlind) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  rig.camera.once_ahead = 5s;
  rig.tick();
  rig.camera.fails = true;  // and then nothing is seen any more
  rig.run(400ms);
  EXPECT_FALSE(rig.loop.status().thrust_allowed);
  EXPECT_EQ(rig.thrust(), 0.0);
  EXPECT_EQ(rig.left.pressed() + rig.right.pressed(), 2.0);
}

TEST(DriveLoopStop, OnOneBrakeItIsWatchedUntilItStands) {
  DriveRig rig;
  ASSERT_TRUE(rig.set_off());
  rig.run(300ms);
  rig.left.broken = true;
  rig.tick();
  rig.run(50ms);
  ASSERT_EQ(rig.loop.status().end, DriveEnd::brake_fault);
  ASSERT_FALSE(rig.autopilot.said.armed) << "disarmed at once, and still rolling";
  ASSERT_GT(rig.speed_m_s, 0.05);
  rig.run(100ms);
  EXPECT_FALSE(rig.loop.done()) << "the stop goes by what is seen";
  rig.run(6s);
  EXPECT_TRUE(rig.loop.done());
  EXPECT_EQ(rig.speed_m_s, 0.0);
  EXPECT_EQ(rig.right.pressed(), 1.0);
  EXPECT_EQ(rig.journal.count("faulted: standing"), 1U);
}

TEST(DriveLoopStop, DevicesThatFailAreNamedOnce) {
  DriveRig rig;
  ASSERT_TRUE(rig.run_until(DrivePhase::driving));
  rig.camera.fails = true;
  rig.alive.disconnect();
  rig.depth.disconnect();
  rig.shows_depth = false;
  rig.run(2s);
  EXPECT_EQ(rig.journal.count("it does not answer"), 1U);
  EXPECT_EQ(rig.journal.count("alive"), 1U);
  EXPECT_EQ(rig.journal.count("depth"), 1U);
}

TEST(DriveLoopStop, AMissionThatMakesNoSenseStartsNoMotor) {
  DriveRig rig({{std::numeric_limits<double>::quiet_NaN(), 0.0}});
  rig.run(1s);
  EXPECT_EQ(rig.loop.status().end, DriveEnd::refused);
  EXPECT_TRUE(rig.autopilot.asked.empty());
}

TEST(DriveLoopStop, WhoStandsAtTheGoalHasArrived) {
  DriveRig rig({}, 0.1);
  rig.run(1s);
  EXPECT_EQ(rig.loop.status().end, DriveEnd::arrived);
  EXPECT_TRUE(rig.autopilot.asked.empty());
}

TEST(DriveLoopStop, NoStepsAndNotAtTheGoalIsRefused) {
  DriveRig rig({}, 1.0);
  rig.run(1s);
  EXPECT_EQ(rig.loop.status().end, DriveEnd::refused);
  EXPECT_TRUE(rig.autopilot.asked.empty());
}

}  // namespace
}  // namespace forager::flight
