// How missions end when something is wrong: on the ground, in the air, and when somebody else takes over.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/flight/mission_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

// A mission that would go back and forth for ever.
struct Patrol : ScriptedPolicy {
  Patrol() {
    go(0.0, 1.0);
    for_ever = true;
  }
};

bool asked_for(const FakeAutopilot& autopilot, const std::string& what) {
  return std::find(autopilot.asked.begin(), autopilot.asked.end(), what) != autopilot.asked.end();
}

struct Trouble {
  const char* name;
  EndReason reason;
  hal::Duration by;  // from the trouble to being on the ground
  void (*make)(MissionRig& rig);
};

class RobotLoopTrouble : public ::testing::TestWithParam<Trouble> {};

TEST_P(RobotLoopTrouble, EndsOnTheGroundInTime) {
  Patrol policy;
  MissionRig rig(policy);
  rig.config.limits.reader_allowance = 10s;
  rig.config.limits.pose_allowance = 2s;
  rig.config.limits.store_allowance = 5s;
  rig.config.limits.flight_time = 40s;
  rig.reader.tags = {{1, 1, 1.8}, {3, 1, 1.8}};
  rig.autopilot.set_battery(0.9);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 3; }, 60s));
  GetParam().make(rig);
  const hal::Instant trouble = rig.now;
  ASSERT_TRUE(rig.run_to(MissionPhase::landing, GetParam().by));
  const hal::Vec3 where = rig.autopilot.body.position;
  const std::uint32_t setpoints = rig.autopilot.setpoints;
  ASSERT_TRUE(rig.run_to(MissionPhase::done, GetParam().by - (rig.now - trouble)));
  EXPECT_TRUE(rig.on_the_ground());
  EXPECT_EQ(rig.status().end, GetParam().reason);
  EXPECT_FALSE(rig.status().detail.empty());
  EXPECT_EQ(rig.autopilot.setpoints, setpoints) << "no goal is sent while it lands";
  EXPECT_LT(hal::distance_xy(where, rig.autopilot.body.position), 0.6) << "comes down where it was";
  EXPECT_FALSE(rig.reader.radiating);
  EXPECT_FALSE(rig.lamp.active());
}

INSTANTIATE_TEST_SUITE_P(
    All, RobotLoopTrouble,
    ::testing::Values(
        Trouble{"Battery", EndReason::battery, 10s, [](MissionRig& rig) { rig.autopilot.set_battery(0.19); }},
        Trouble{"ReaderLost", EndReason::reader_lost, 20s, [](MissionRig& rig) { rig.reader.lose(); }},
        Trouble{"ReaderSaysNothing", EndReason::reader_lost, 20s,
                [](MissionRig& rig) { rig.reader.status.speaks = false; }},
        Trouble{"ReaderFailed", EndReason::reader_lost, 10s,
                [](MissionRig& rig) { rig.reader.lose(reader::LinkPhase::failed); }},
        Trouble{"PoseLost", EndReason::pose_lost, 12s, [](MissionRig& rig) { rig.pose_good = false; }},
        Trouble{"PoseUnplugged", EndReason::pose_lost, 12s, [](MissionRig& rig) { rig.pose.disconnect(); }},
        Trouble{"StoreFull", EndReason::store_failed, 60s, [](MissionRig& rig) { rig.store.full = true; }},
        Trouble{"TimeLimit", EndReason::time_limit, 60s, [](MissionRig&) {}},
        Trouble{"Halt", EndReason::halted, 10s, [](MissionRig& rig) { rig.loop->halt(); }}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(RobotLoopAbort, APilotHasTheVehicleAtOnce) {
  Patrol policy;
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.autopilot.pilot_takes_over();
  rig.tick();
  EXPECT_EQ(rig.status().end, EndReason::autopilot_mode);
  EXPECT_TRUE(rig.loop->done());
  EXPECT_FALSE(rig.autopilot.goal) << "the goal in force is taken back";
  const auto asked = rig.autopilot.asked.size();
  const auto setpoints = rig.autopilot.setpoints;
  rig.run(20s);
  EXPECT_EQ(rig.autopilot.asked.size(), asked) << "never fights the pilot";
  EXPECT_EQ(rig.autopilot.setpoints, setpoints);
  EXPECT_TRUE(rig.autopilot.state().armed);
}

TEST(RobotLoopAbort, APilotMayTakeOverTheLanding) {
  Patrol policy;
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.loop->halt();
  ASSERT_TRUE(rig.run_to(MissionPhase::landing));
  rig.run(500ms);
  rig.autopilot.pilot_takes_over();
  rig.tick();
  rig.tick();
  EXPECT_TRUE(rig.loop->done());
  EXPECT_EQ(rig.status().end, EndReason::halted);
  EXPECT_EQ(std::count(rig.autopilot.asked.begin(), rig.autopilot.asked.end(), "land"), 1);
}

TEST(RobotLoopAbort, ASilentAutopilotMakesUsSilent) {
  Patrol policy;
  MissionRig rig(policy);
  rig.config.limits.autopilot_allowance = 15s;
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.autopilot.link_up = false;
  rig.tick();
  rig.tick();
  ASSERT_EQ(rig.status().phase, MissionPhase::silent);
  const auto feeds = rig.autopilot.feeds;
  const auto setpoints = rig.autopilot.setpoints;
  rig.run(14s);
  EXPECT_EQ(rig.status().phase, MissionPhase::silent);
  rig.run(2s);
  EXPECT_TRUE(rig.loop->done());
  EXPECT_EQ(rig.autopilot.feeds, feeds) << "not even heartbeats";
  EXPECT_EQ(rig.autopilot.setpoints, setpoints);
  EXPECT_EQ(rig.status().end, EndReason::autopilot_lost);
}

TEST(RobotLoopAbort, AnAutopilotThatComesBackIsLanded) {
  Patrol policy;
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.autopilot.link_up = false;
  rig.run(3s);
  rig.autopilot.link_up = true;
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 20s));
  EXPECT_TRUE(rig.on_the_ground());
  EXPECT_EQ(rig.status().end, EndReason::autopilot_lost);
}

TEST(RobotLoopAbort, RefusalsNeverLeaveTheGround) {
  for (const char* refused : {"guided", "arm", "takeoff"}) {
    Patrol policy;
    MissionRig rig(policy);
    rig.autopilot.refuse_guided = refused == std::string("guided");
    rig.autopilot.refuse_arm = refused == std::string("arm");
    rig.autopilot.refuse_takeoff = refused == std::string("takeoff");
    rig.watch = [&] { EXPECT_LT(hal::norm(rig.autopilot.body.position), 0.01); };
    ASSERT_TRUE(rig.run_to(MissionPhase::done, 60s)) << refused;
    EXPECT_EQ(rig.status().end, EndReason::refused);
    EXPECT_NE(rig.status().detail.find("PreArm"), std::string::npos) << "says why";
    EXPECT_FALSE(rig.autopilot.state().armed);
    EXPECT_EQ(rig.autopilot.setpoints, 0U);
    EXPECT_TRUE(rig.status().decisions.empty());
  }
}

TEST(RobotLoopAbort, WhatIsMissingAtTheStartIsNamed) {
  struct Missing {
    EndReason reason;
    void (*make)(MissionRig& rig);
  };
  for (const Missing& missing :
       {Missing{EndReason::autopilot_lost, [](MissionRig& rig) { rig.autopilot.link_up = false; }},
        Missing{EndReason::reader_lost, [](MissionRig& rig) { rig.reader.lose(); }},
        Missing{EndReason::reader_lost, [](MissionRig& rig) { rig.reader.status.speaks = false; }},
        Missing{EndReason::reader_lost, [](MissionRig& rig) { rig.reader.lose(reader::LinkPhase::failed); }},
        Missing{EndReason::pose_lost, [](MissionRig& rig) { rig.pose_good = false; }},
        Missing{EndReason::halted, [](MissionRig& rig) {
                  rig.make_loop();
                  rig.loop->halt();
                }}}) {
    Patrol policy;
    MissionRig rig(policy);
    rig.config.limits.start_timeout = 10s;
    missing.make(rig);
    ASSERT_TRUE(rig.run_to(MissionPhase::done, 12s));
    EXPECT_EQ(rig.status().end, missing.reason);
    EXPECT_FALSE(rig.status().detail.empty());
    EXPECT_TRUE(rig.autopilot.asked.empty()) << "nothing was asked of the autopilot";
  }
}

TEST(RobotLoopAbort, AVehicleSomebodyArmedIsLeftAlone) {
  Patrol policy;
  MissionRig rig(policy);
  rig.autopilot.preset_armed();
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 10s));
  EXPECT_EQ(rig.status().end, EndReason::refused);
  EXPECT_TRUE(rig.autopilot.state().armed);
  EXPECT_TRUE(rig.autopilot.asked.empty());
}

TEST(RobotLoopAbort, DisarmingInFlightEndsTheMission) {
  Patrol policy;
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.autopilot.disarm();
  rig.tick();
  EXPECT_TRUE(rig.loop->done());
  EXPECT_EQ(rig.status().end, EndReason::autopilot_mode);
}

TEST(RobotLoopAbort, AReaderThatComesBackCostsOnlyTime) {
  Patrol policy;
  MissionRig rig(policy);
  rig.config.limits.reader_allowance = 20s;
  rig.reader.luck = 1.0;
  rig.reader.tags = {{1.5, 1, 1.8}};
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.reader.lose();
  const auto decided = policy.seen.size();
  ASSERT_TRUE(rig.run_to(MissionPhase::listening));
  rig.run(10s);
  EXPECT_LE(policy.seen.size(), decided + 1) << "no window closes without a reader";
  rig.reader.recover();
  ASSERT_TRUE(rig.run_until([&] { return policy.seen.size() >= decided + 2; }, 20s));
  EXPECT_EQ(rig.status().end, EndReason::none);
}

TEST(RobotLoopAbort, AStoreThatRecoversLosesNoRead) {
  Patrol policy;
  MissionRig rig(policy);
  rig.config.limits.store_allowance = 30s;
  rig.config.limits.flight_time = 30s;
  for (int i = 0; i < 30; ++i) rig.reader.tags.push_back({0.3 * i, 1.5, 1.8});
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.store.full = true;
  rig.run(10s);
  EXPECT_GT(rig.loop->unstored_reads(), 0U);
  rig.store.full = false;
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 60s));
  EXPECT_EQ(rig.loop->unstored_reads(), 0U);
  const auto items = *rig.store.items();
  std::uint64_t stored = 0;
  for (const auto& item : items) stored += item.count;
  EXPECT_EQ(stored, rig.status().reads);
  EXPECT_EQ(rig.status().end, EndReason::time_limit);
}

TEST(RobotLoopAbort, ReadsTheStoreRefusesToTheEndAreCounted) {
  Patrol policy;
  MissionRig rig(policy);
  rig.config.limits.store_allowance = 5s;
  rig.reader.tags = {{1, 1, 1.8}};
  rig.store.full = true;
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  EXPECT_EQ(rig.status().end, EndReason::store_failed);
  EXPECT_GT(rig.loop->unstored_reads(), 0U);
  EXPECT_TRUE(rig.on_the_ground());
}

TEST(RobotLoopAbort, ADarkLampGroundsNobody) {
  Patrol policy;
  MissionRig rig(policy);
  rig.lamp.disconnect();
  ASSERT_TRUE(rig.run_until([&] { return rig.loop && rig.status().decisions.size() == 2; }, 60s));
  rig.lamp.disconnect(false);
  rig.run(3s);
  EXPECT_TRUE(rig.lamp.active()) << "tried again";
}

TEST(RobotLoopAbort, TakeoffThatGetsNowhereIsGivenUp) {
  Patrol policy;
  MissionRig rig(policy);
  rig.autopilot.frozen = true;
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  EXPECT_EQ(rig.status().end, EndReason::refused);
  EXPECT_TRUE(asked_for(rig.autopilot, "land"));
  EXPECT_FALSE(rig.autopilot.state().armed);
}

}  // namespace
}  // namespace forager::flight
