// Whose the vehicle is, and what halt() and the end of the object leave behind.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/flight/hybrid_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

class HybridHands : public test::HybridModeTest {
 protected:
  void SetUp() override { start({bar}, {bar}); }
  [[nodiscard]] auto times(const char* what) const {
    return std::count(autopilot.asked.begin(), autopilot.asked.end(), std::string(what));
  }
};

TEST_F(HybridHands, MotorsThatStartInAPilotsHandsAreStoppedAgain) {
  autopilot.ignore_arm = true;
  ASSERT_TRUE(run_until(HybridPhase::arming));
  autopilot.pilot_takes_over();
  autopilot.preset_armed();  // our request had arrived before
  run(10s);
  EXPECT_EQ(mode->status().end, HybridEnd::pilot);
  EXPECT_EQ(times("takeoff"), 0);
  EXPECT_FALSE(autopilot.state().armed) << "on the ground, on our request, and nobody knows";
  EXPECT_TRUE(mode->done());
}

TEST_F(HybridHands, AnArmingUnderWayIsDroppedWhenAPilotTakesOver) {
  autopilot.ignore_arm = true;
  ASSERT_TRUE(run_until(HybridPhase::arming));
  autopilot.pilot_takes_over();
  tick();
  EXPECT_EQ(times("cancel"), 1);
  run(10s);
  EXPECT_EQ(times("disarm"), 1) << "asked once, and then it is his";
  EXPECT_TRUE(mode->done());
}

TEST_F(HybridHands, HaltWhileItRollsStopsTheWheelsWithoutAnUpdate) {
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  mode->halt();
  EXPECT_EQ(ground.halts, 1);
}

TEST_F(HybridHands, HaltInTheAirAsksToLandWithoutAnUpdate) {
  ASSERT_TRUE(run_until(HybridPhase::flying));
  mode->halt();
  EXPECT_EQ(times("halt"), 1);
}

TEST_F(HybridHands, AHaltWhoseLandingShowsBeforeTheNextUpdateIsNotTakenForAPilot) {
  ASSERT_TRUE(run_until(HybridPhase::flying));
  mode->halt();
  autopilot.request_land(now);  // what a bridge does in halt()
  run(60s);
  EXPECT_EQ(mode->status().end, HybridEnd::halted);
  EXPECT_FALSE(autopilot.state().armed);
}

TEST_F(HybridHands, HaltTakesNothingFromAPilotInTheAir) {
  ASSERT_TRUE(run_until(HybridPhase::flying));
  autopilot.pilot_takes_over();
  tick();
  mode->halt();
  run(5s);
  EXPECT_EQ(mode->status().end, HybridEnd::pilot);
  EXPECT_EQ(times("halt") + times("land"), 0);
}

TEST_F(HybridHands, TheEndOfTheObjectStopsOrLands) {
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  mode.reset();
  EXPECT_EQ(ground.halts, 1);
  autopilot = FakeAutopilot{};
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::flying));
  mode.reset();
  EXPECT_EQ(times("halt"), 1);
}

// On wheels the ground driver reads the camera: what comes after is no jump and no reset of the estimator.
TEST_F(HybridHands, TheEstimatorIsNotResetWhenTheDriversTakeTurns) {
  run(200s);
  ASSERT_EQ(mode->status().end, HybridEnd::arrived) << mode->status().detail;
  EXPECT_EQ(vision.stats().jumps, 0U);
  EXPECT_EQ(autopilot.vision_resets, 0);
}

}  // namespace
}  // namespace forager::flight
