#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/flight/hybrid_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::HybridModeTest;

TEST_F(HybridModeTest, RollsFliesOverAndRollsOn) {
  start({bar}, {bar});
  run(200s);
  ASSERT_TRUE(mode->done()) << to_string(mode->status().phase) << journal.text();
  EXPECT_EQ(mode->status().end, HybridEnd::arrived) << mode->status().detail;
  EXPECT_EQ(mode->status().hops, 1U);
  EXPECT_NEAR(autopilot.body.position.x, 8.0, 0.2);
  EXPECT_NEAR(autopilot.body.position.z, 0.0, 1e-9);
  EXPECT_GT(lowest_over, 0.15) << "wheels above the bar all the way over it";
  EXPECT_LT(highest, 0.4 + 0.4 + 0.3);
  EXPECT_FALSE(autopilot.state().armed);
  ASSERT_EQ(ground.ways.size(), 2U);
  EXPECT_NEAR(ground.ways[0].back().x, 3.9 - 0.95, 1e-9) << "to the take-off";
  EXPECT_GT(ground.ways[1].front().x, 4.1 + 0.65) << "on from where it landed";
  const std::vector<std::string> asked{"guided", "arm", "takeoff", "land"};
  EXPECT_EQ(autopilot.asked, asked);
}

TEST_F(HybridModeTest, OnlyRollsWhereTheGroundIsFree) {
  start({}, {});
  run(100s);
  EXPECT_EQ(mode->status().end, HybridEnd::arrived);
  EXPECT_TRUE(autopilot.asked.empty());
  EXPECT_EQ(highest, 0.0);
}

TEST_F(HybridModeTest, HopsOverWhatItMeetsIfItIsKnown) {
  start({}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  run(3s);
  ground.block_next = true;
  run(200s);
  EXPECT_EQ(mode->status().end, HybridEnd::arrived) << mode->status().detail;
  EXPECT_EQ(mode->status().hops, 1U);
  EXPECT_NEAR(autopilot.body.position.x, 8.0, 0.2);
  EXPECT_GT(lowest_over, 0.15);
}

TEST_F(HybridModeTest, StopsBeforeWhatItDoesNotKnow) {
  start({}, {});
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  ground.block_next = true;
  run(10s);
  EXPECT_EQ(mode->status().end, HybridEnd::no_way);
  EXPECT_TRUE(autopilot.asked.empty()) << "no motor was started";
}

TEST_F(HybridModeTest, AGroundDriverThatGivesUpEndsIt) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  ground.fail_next = true;
  run(10s);
  EXPECT_EQ(mode->status().end, HybridEnd::ground_failed);
  EXPECT_EQ(mode->status().detail, "a box");
}

TEST_F(HybridModeTest, RefusalsOfTheAutopilotEndItOnTheGround) {
  for (const int what : {0, 1, 2}) {
    autopilot = FakeAutopilot{};
    autopilot.refuse_guided = what == 0;
    autopilot.refuse_arm = what == 1;
    autopilot.refuse_takeoff = what == 2;
    start({bar}, {bar});
    run(100s);
    EXPECT_EQ(mode->status().end, HybridEnd::refused) << what;
    EXPECT_NE(mode->status().detail.find("PreArm"), std::string::npos);
    EXPECT_FALSE(autopilot.state().armed) << what;
    EXPECT_EQ(highest, 0.0);
  }
}

TEST_F(HybridModeTest, NoHopWithAnEmptyBattery) {
  start({bar}, {bar});
  autopilot.set_battery(0.15);
  run(100s);
  EXPECT_EQ(mode->status().end, HybridEnd::battery);
  EXPECT_TRUE(autopilot.asked.empty());
}

TEST_F(HybridModeTest, DoesNotTakeOffElsewhere) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::rolling));
  while (mode->status().phase == HybridPhase::rolling) tick();
  autopilot.body.position.x += 0.5;  // somebody pushed it
  run(20s);
  EXPECT_EQ(mode->status().end, HybridEnd::off_takeoff);
  EXPECT_TRUE(autopilot.asked.empty());
}

TEST_F(HybridModeTest, LandsWhenThePoseIsLostInTheAir) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::flying));
  pose.see = false;
  const hal::Instant lost = now;
  while (mode->status().phase == HybridPhase::flying) tick();
  EXPECT_GE(now - lost, 500ms) << "a dropout is not a loss";
  EXPECT_LE(now - lost, 740ms) << "0.3 s until silence counts, and 0.4 s of it";
  run(60s);
  EXPECT_EQ(mode->status().end, HybridEnd::pose_lost);
  EXPECT_FALSE(autopilot.state().armed);
  EXPECT_LT(autopilot.body.position.z, 0.05) << "it stands";
}

TEST_F(HybridModeTest, HaltLandsAndEnds) {
  for (const HybridPhase phase :
       {HybridPhase::rolling, HybridPhase::climbing, HybridPhase::flying, HybridPhase::landing}) {
    autopilot = FakeAutopilot{};
    start({bar}, {bar});
    ASSERT_TRUE(run_until(phase)) << to_string(phase);
    mode->halt();
    run(60s);
    EXPECT_EQ(mode->status().end, HybridEnd::halted) << to_string(phase);
    EXPECT_TRUE(mode->done());
    EXPECT_FALSE(autopilot.state().armed);
    EXPECT_LT(autopilot.body.position.z, 0.05) << "it stands";
    if (phase == HybridPhase::rolling) {
      EXPECT_GT(ground.halts, 0);
    }
  }
}

TEST_F(HybridModeTest, APilotInTheAirKeepsIt) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::flying));
  autopilot.pilot_takes_over();
  const std::size_t asked = autopilot.asked.size();
  run(20s);
  EXPECT_EQ(mode->status().end, HybridEnd::pilot);
  EXPECT_EQ(autopilot.asked.size(), asked) << "nothing is asked any more";
  EXPECT_FALSE(autopilot.goal);
}

TEST_F(HybridModeTest, ASilentAutopilotIsLeftToItsFailSafe) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::flying));
  autopilot.link_up = false;
  run(5s);
  EXPECT_EQ(mode->status().end, HybridEnd::autopilot_lost);
  EXPECT_TRUE(mode->done());
}

TEST_F(HybridModeTest, AVehicleThatDoesNotClimbIsDisarmed) {
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::climbing));
  autopilot.frozen = true;
  run(60s);
  EXPECT_EQ(mode->status().end, HybridEnd::late);
  EXPECT_FALSE(autopilot.state().armed);
}

TEST_F(HybridModeTest, FliesForwardOnly) {
  bar.yaw_rad = 0.3;
  start({bar}, {bar});
  ASSERT_TRUE(run_until(HybridPhase::flying));
  while (mode->status().phase == HybridPhase::flying) {
    tick();
    const hal::Vec3 v = hal::rotate_yaw(autopilot.velocity, -autopilot.body.yaw_rad);
    EXPECT_LT(std::abs(v.y), 0.1) << "sideways never";
  }
}

}  // namespace
}  // namespace forager::flight
