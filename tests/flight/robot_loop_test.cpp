#include "flight/robot_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/flight/mission_rig.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using hal::deg_to_rad;
using hal::kPi;

mocks::Box wall_at(double x) { return {{x, -5, 0}, {x + 0.5, 5, 4}}; }

// Everything that must hold at every moment of every mission.
struct ForwardOnly {
  MissionRig* rig;
  void operator()() const {
    const FakeAutopilot& vehicle = rig->autopilot;
    const hal::Vec3 v = hal::rotate_yaw(vehicle.velocity, -vehicle.body.yaw_rad);
    EXPECT_LT(std::abs(v.y), 0.15) << "sideways at " << hal::to_seconds(rig->now);
    EXPECT_GT(v.x, -0.15) << "backwards at " << hal::to_seconds(rig->now);
  }
};

TEST(RobotLoop, StigmergyReadsAnAisleAndComesDown) {
  mocks::World aisle;
  aisle.obstacles = {{{-1, 1.75, 0}, {9, 2.3, 3}}, {{-1, -2.3, 0}, {9, -1.75, 3}}, wall_at(9.0)};
  StigmergyConfig soan;
  soan.heights_m = {1.8};
  Stigmergy policy(soan);
  MissionRig rig(policy, aisle);
  for (int i = 0; i < 80; ++i) rig.reader.tags.push_back({0.1 * i, i % 2 == 0 ? 1.9 : -1.9, 1.8});
  double widest = 0.0;
  rig.watch = [&] {
    ForwardOnly{&rig}();
    widest = std::max(widest, std::abs(rig.autopilot.body.position.y));
  };
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 400s));

  EXPECT_EQ(rig.status().end, EndReason::no_new_tags);
  EXPECT_TRUE(rig.on_the_ground());
  EXPECT_FALSE(rig.reader.radiating);
  EXPECT_LT(widest, 1.75 - 0.6) << "a body of 1.2 m clears the shelves";
  EXPECT_GE(rig.status().unique_tags, 77U);
  const auto items = *rig.store.items();
  EXPECT_EQ(items.size(), rig.status().unique_tags);
  EXPECT_EQ(rig.loop->unstored_reads(), 0U);
  std::uint64_t stored = 0;
  for (const auto& item : items) stored += item.count;
  EXPECT_EQ(stored, rig.status().reads) << "no read lost, none counted twice";
  double by_port = 0.0;
  for (const PortTally& port : rig.loop->ports()) by_port += port.new_tags;
  EXPECT_DOUBLE_EQ(by_port, static_cast<double>(rig.status().unique_tags));
  EXPECT_GT(rig.status().path_m, 4.0);
  EXPECT_EQ(rig.lamp.edges().size(), 2U) << "on with arming, off with disarming";
  EXPECT_FALSE(rig.lamp.active());
  std::size_t at = 0;
  for (const char* phase : {"guided", "arming", "takeoff", "stepping", "landing", "done"}) {
    at = rig.journal.find(std::string("phase ") + phase, at);
    ASSERT_NE(at, std::string::npos) << phase;
  }
  EXPECT_EQ(rig.journal.count("window 1:"), 1U);
}

TEST(RobotLoop, TurnsAndGoesWhereThePolicySays) {
  ScriptedPolicy policy;
  policy.go(0.0, 1.0);
  policy.go(kPi / 2, 1.0);
  policy.go(deg_to_rad(-120.0), 0.5);
  MissionRig rig(policy);
  rig.watch = ForwardOnly{&rig};
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  EXPECT_EQ(rig.status().end, EndReason::path_complete);
  const auto& decisions = rig.status().decisions;
  ASSERT_EQ(decisions.size(), 4U);
  EXPECT_EQ(decisions[0].kind, DecisionKind::forward);
  EXPECT_EQ(decisions[1].kind, DecisionKind::turn_left);
  EXPECT_EQ(decisions[2].kind, DecisionKind::turn_back);
  EXPECT_EQ(decisions[3].kind, DecisionKind::land);
  const hal::Vec3 corners[] = {{1, 0, 1.8}, {1, 1, 1.8}, {0.75, 1 - 0.5 * std::sin(deg_to_rad(60.0)), 1.8}};
  for (std::size_t i = 0; i < 3; ++i) {
    const hal::Pose& there = decisions[i + 1].from;
    EXPECT_NEAR(there.position.x, corners[i].x, 0.2);
    EXPECT_NEAR(there.position.y, corners[i].y, 0.2);
    EXPECT_NEAR(there.position.z, corners[i].z, 0.2);
    EXPECT_LT(std::abs(hal::angle_difference(there.yaw_rad, decisions[i].heading_rad)), deg_to_rad(15.0));
    EXPECT_FALSE(policy.seen[i + 1].blocked);
    EXPECT_NEAR(policy.seen[i + 1].moved_m, decisions[i].step_m, 0.3);
  }
}

TEST(RobotLoop, NeverEntersABlockedOrUnseenWay) {
  enum class Sight { wall, blind, stalled, unplugged };
  for (const Sight sight : {Sight::wall, Sight::blind, Sight::stalled, Sight::unplugged}) {
    ScriptedPolicy policy;
    for (int i = 0; i < 4; ++i) policy.go(0.0, 1.0);
    mocks::World world;
    if (sight == Sight::wall) world.obstacles.push_back(wall_at(1.7));
    MissionRig rig(policy, world);
    if (sight == Sight::blind) rig.camera.set_fault(mocks::DepthFault::blind);
    if (sight == Sight::stalled) rig.camera.set_fault(mocks::DepthFault::stall);
    if (sight == Sight::unplugged) rig.camera.set_fault(mocks::DepthFault::disconnect);
    rig.watch = [&] { EXPECT_LT(std::abs(rig.autopilot.body.position.x), 0.02); };
    ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
    ASSERT_EQ(policy.seen.size(), 5U);
    for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(policy.seen[i].blocked);
    EXPECT_TRUE(rig.on_the_ground());
  }
}

TEST(RobotLoop, LooksAfterTheTurnNotBefore) {
  // Free ahead, a wall to the left: what the camera saw before the turn must not count.
  ScriptedPolicy policy;
  policy.go(kPi / 2, 1.0);
  mocks::World world;
  world.obstacles.push_back({{-3, 1.75, 0}, {3, 2.3, 4}});
  MissionRig rig(policy, world);
  rig.watch = [&] { EXPECT_LT(std::abs(rig.autopilot.body.position.y), 0.02); };
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 60s));
  EXPECT_TRUE(policy.seen.at(1).blocked);
}

TEST(RobotLoop, StopsBeforeAWallThatAppearsOnTheWay) {
  for (const double speed : {0.25, 0.5, 1.0}) {
    ScriptedPolicy policy;
    policy.go(0.0, 8.0);
    MissionRig rig(policy);
    rig.config.step.speed_m_s = speed;
    bool up = false;
    double wall_x = 0.0;
    rig.watch = [&] {
      const double x = rig.autopilot.body.position.x;
      if (!up && x > 1.5) {
        up = true;
        wall_x = x + 2.1;  // as near as it can come before the guard must act
        rig.world.obstacles.push_back(wall_at(wall_x));
      }
      ForwardOnly{&rig}();
    };
    ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
    EXPECT_TRUE(policy.seen.at(1).blocked);
    EXPECT_LT(policy.seen.at(1).moved_m, 2.8);
    const double left_m = wall_x - rig.autopilot.body.position.x;
    EXPECT_GT(left_m, 1.2) << "stops within what the guard reckons with, at " << speed;
  }
}

TEST(RobotLoop, StopsWhenTheCameraGoesBlindOnTheWay) {
  ScriptedPolicy policy;
  policy.go(0.0, 8.0);
  MissionRig rig(policy);
  rig.watch = [&] {
    if (rig.autopilot.body.position.x > 1.5) rig.camera.set_fault(mocks::DepthFault::stall);
  };
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  EXPECT_TRUE(policy.seen.at(1).blocked);
  EXPECT_LT(rig.autopilot.body.position.x, 2.4);
}

TEST(RobotLoop, AVehicleThatCannotMoveIsGivenUpInTime) {
  ScriptedPolicy policy;
  policy.go(0.0, 1.0);
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_to(MissionPhase::listening));
  rig.autopilot.frozen = true;
  ASSERT_TRUE(rig.run_until([&] { return policy.seen.size() > 1; }, 60s));
  EXPECT_FALSE(policy.seen[1].blocked);
  EXPECT_LT(policy.seen[1].moved_m, 0.1);
  EXPECT_EQ(rig.journal.count("late after"), 1U);
  EXPECT_LT(rig.autopilot.goal->position_world.x, 0.1) << "and the rest of the way is not flown later";
}

TEST(RobotLoop, CountsTriesAndFreshTags) {
  ScriptedPolicy policy;
  for (int i = 0; i < 4; ++i) policy.go(0.0, 0.0);
  MissionRig rig(policy);
  rig.reader.luck = 1.0;
  rig.watch = [&] {
    if (rig.loop->status().window == 3 && rig.reader.tags.empty())
      rig.reader.tags = {{1, 0, 1.8}, {0, 1, 1.8}};
  };
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  ASSERT_EQ(policy.seen.size(), 5U);
  EXPECT_EQ(policy.seen[0].tries, 1U);
  EXPECT_EQ(policy.seen[1].tries, 2U);
  EXPECT_EQ(policy.seen[2].tries, 0U);
  EXPECT_EQ(policy.seen[2].new_tags, 2U);
  EXPECT_EQ(policy.seen[2].fresh_tags, 2U);
  EXPECT_EQ(policy.seen[3].tries, 1U) << "heard again is not new";
  EXPECT_EQ(policy.seen[4].tries, 2U);
}

TEST(RobotLoop, TagsOfATurnDoNotPullButCount) {
  ScriptedPolicy policy;
  policy.go(kPi, 0.0);
  MissionRig rig(policy);
  rig.reader.luck = 1.0;
  rig.watch = [&] {
    const double yaw = std::abs(rig.autopilot.body.yaw_rad);
    rig.reader.tags.assign(yaw > 0.5 && yaw < 2.5 ? 1 : 0, {0.5, 0.5, 1.8});
  };
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  EXPECT_EQ(policy.seen.at(1).new_tags, 0U);
  EXPECT_EQ(policy.seen.at(1).fresh_tags, 1U);
  EXPECT_EQ(policy.seen.at(1).tries, 0U);
  EXPECT_EQ(rig.status().unique_tags, 1U);
}

TEST(RobotLoop, ReadsCarryThePoseAtWhichTheyWereHeard) {
  ScriptedPolicy policy;
  policy.go(0.0, 3.0);
  MissionRig rig(policy);
  rig.reader.delay = 1s;  // two thirds of a metre at this speed
  rig.reader.luck = 1.0;
  rig.reader.range_m = 0.3;
  rig.reader.tags = {{2.0, 0, 1.8}};
  ASSERT_TRUE(rig.run_to(MissionPhase::done, 120s));
  const auto items = *rig.store.items();
  ASSERT_EQ(items.size(), 1U);
  EXPECT_TRUE(items[0].pose_known);
  EXPECT_NEAR(items[0].best_pose_world.position.x, 2.0, 0.35);
}

TEST(RobotLoop, AWorldFrameThatMovesDoesNotMoveTheVehicle) {
  ScriptedPolicy policy;
  policy.window = 5s;
  for (int i = 0; i < 3; ++i) policy.go(0.0, 0.0);
  MissionRig rig(policy);
  ASSERT_TRUE(rig.run_to(MissionPhase::listening));
  const hal::Vec3 before = rig.autopilot.body.position;
  rig.pose_shift = {7.0, -3.0, 1.0};
  ++rig.pose_resets;
  rig.tick();
  rig.tick();
  ASSERT_TRUE(rig.autopilot.goal);
  EXPECT_LT(hal::norm(rig.autopilot.goal->position_world - (before + rig.pose_shift)), 0.3);
}

TEST(RobotLoop, SteadyStateAllocatesNothing) {
  mocks::World aisle;
  aisle.obstacles = {{{-1, 1.75, 0}, {30, 2.3, 3}}, {{-1, -2.3, 0}, {30, -1.75, 3}}};
  StigmergyConfig soan;
  soan.heights_m = {1.8};
  Stigmergy policy(soan);
  MissionRig rig(policy, aisle);
  for (int i = 0; i < 300; ++i) rig.reader.tags.push_back({0.1 * i, i % 2 == 0 ? 1.9 : -1.9, 1.8});
  rig.reader.luck = 0.03;
  class QuietStore final : public reader::InventoryStore {
   public:
    hal::Result<> commit(std::uint64_t batch, std::span<const reader::LocatedRead>) override {
      last_ = batch;
      return {};
    }
    std::uint64_t last_batch() const override { return last_; }
    hal::Result<std::vector<reader::InventoryItem>> items() const override { return {}; }
    hal::Result<> set_fact(const std::string&, const std::string&) override { return {}; }
    hal::Result<std::vector<std::pair<std::string, std::string>>> facts() const override { return {}; }

   private:
    std::uint64_t last_ = 0;
  } store;
  hal::NullJournal journal;
  rig.loop = std::make_unique<RobotLoop>(
      rig.config, RobotDevices{rig.autopilot, rig.reader, rig.camera, rig.pose, store, journal, &rig.lamp},
      policy);
  ASSERT_TRUE(rig.run_until([&] { return rig.loop->status().window >= 8; }, 120s));
  std::uint64_t in_loop = 0;
  std::uint32_t decisions = 0;
  for (int i = 0; i < 1200; ++i) {
    rig.now += MissionRig::kTick;
    rig.body_state.pose = rig.autopilot.body;
    rig.pose.show({rig.now, rig.autopilot.body, hal::PoseConfidence::high, 0});
    const auto before = test::allocation_count();
    rig.loop->update(rig.now);
    in_loop += test::allocation_count() - before;
    decisions = static_cast<std::uint32_t>(rig.loop->status().decisions.size());
  }
  EXPECT_EQ(in_loop, 0U);
  EXPECT_GT(decisions, 20U) << "it did decide and move meanwhile";
}

}  // namespace
}  // namespace forager::flight
