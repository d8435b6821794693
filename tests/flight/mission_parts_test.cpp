// The small parts of a mission: limits, pose history, batches, remembered places, the flown path.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "flight/inventory_sink.hpp"
#include "flight/mission_limits.hpp"
#include "flight/mission_status.hpp"
#include "flight/pose_history.hpp"
#include "flight/tag_memory.hpp"
#include "hal/units.hpp"
#include "tests/flight/mission_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
constexpr hal::Instant kStart{500s};

TEST(MissionLimits, WorstCounts) {
  MissionLimits limits;
  limits.flight_time = 60s;
  Vitals v;
  v.now = kStart;
  v.airborne_since = kStart - 10s;
  v.battery_fraction = 0.5;
  EXPECT_EQ(judge(limits, v).consequence, Consequence::go_on);
  v.battery_fraction = 0.1;
  EXPECT_EQ(judge(limits, v).reason, EndReason::battery);
  v.halt_asked = true;
  EXPECT_EQ(judge(limits, v).reason, EndReason::halted);
  v.guided = false;
  EXPECT_EQ(judge(limits, v).consequence, Consequence::hands_off) << "a pilot's vehicle is not landed";
  v.autopilot_link_up = false;
  EXPECT_EQ(judge(limits, v).consequence, Consequence::fall_silent) << "what it last said is stale";
}

TEST(MissionLimits, AllowancesLastToTheNanosecond) {
  MissionLimits limits;
  limits.flight_time = 60s;
  for (const auto& [set, allowed, reason] :
       {std::tuple{&Vitals::reader_lost_since, limits.reader_allowance, EndReason::reader_lost},
        std::tuple{&Vitals::pose_bad_since, limits.pose_allowance, EndReason::pose_lost},
        std::tuple{&Vitals::store_failing_since, limits.store_allowance, EndReason::store_failed},
        std::tuple{&Vitals::airborne_since, *limits.flight_time, EndReason::time_limit}}) {
    Vitals v;
    v.now = kStart;
    v.*set = kStart - allowed + 1ns;
    EXPECT_EQ(judge(limits, v).consequence, Consequence::go_on);
    v.*set = kStart - allowed;
    EXPECT_EQ(judge(limits, v).reason, reason);
    EXPECT_EQ(judge(limits, v).consequence, Consequence::land);
  }
}

TEST(MissionLimits, AnUnknownBatteryIsNoEmptyOne) {
  Vitals v;
  v.now = kStart;
  EXPECT_EQ(judge({}, v).consequence, Consequence::go_on);
}

hal::Pose pose(double x, double yaw_deg) { return {{x, 0, 1.8}, hal::deg_to_rad(yaw_deg)}; }

TEST(PoseHistory, InterpolatesTheShortWayRound) {
  PoseHistory history;
  EXPECT_FALSE(history.at(kStart, 1s));
  history.add(kStart, pose(1.0, 170.0));
  history.add(kStart + 100ms, pose(2.0, -170.0));
  const auto middle = history.at(kStart + 50ms, 0ms);
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->position.x, 1.5, 1e-9);
  EXPECT_NEAR(std::abs(middle->yaw_rad), hal::kPi, 1e-9);
  EXPECT_FALSE(history.at(kStart - 1ns, 1s)) << "before anything is known";
  EXPECT_NEAR(history.at(kStart + 200ms, 100ms)->position.x, 2.0, 1e-9);
  EXPECT_FALSE(history.at(kStart + 201ms, 100ms)) << "too far ahead of the newest";
}

TEST(PoseHistory, KeepsTheNewestWhenFull) {
  PoseHistory history;
  for (int i = 0; i < 2000; ++i) history.add(kStart + i * 33ms, pose(i, 0.0));
  history.add(kStart, pose(-99.0, 0.0));  // late: ignored
  EXPECT_NEAR(history.at(kStart + 1999 * 33ms, 0ms)->position.x, 1999.0, 1e-9);
  EXPECT_NEAR(history.at(kStart + 1600 * 33ms + 11ms, 0ms)->position.x, 1600.0 + 1.0 / 3.0, 1e-6);
  EXPECT_FALSE(history.at(kStart + 1400 * 33ms, 0ms));
}

reader::LocatedRead read_of(std::uint32_t tag) {
  reader::LocatedRead read;
  read.read.epc = epc_of(tag);
  read.read.port = 1;
  return read;
}

TEST(InventorySink, CommitsBySizeAndByAge) {
  FaultyInventory store;
  hal::NullJournal journal;
  InventorySink sink(store, journal, {.batch_reads = 4, .batch_interval = 1s, .retry_interval = 500ms});
  for (std::uint32_t i = 0; i < 3; ++i) sink.add(read_of(i));
  sink.update(kStart);
  EXPECT_EQ(store.last_batch(), 0U);
  sink.update(kStart + 1s);
  EXPECT_EQ(store.last_batch(), 1U) << "old enough";
  for (std::uint32_t i = 0; i < 4; ++i) sink.add(read_of(i));
  sink.update(kStart + 1s);
  EXPECT_EQ(store.last_batch(), 2U) << "many enough";
  EXPECT_EQ(sink.waiting(), 0U);
}

TEST(InventorySink, ARefusedBatchKeepsItsNumberAndItsPlace) {
  FaultyInventory store;
  mocks::TextJournal journal;
  InventorySink sink(store, journal, {.batch_reads = 2, .batch_interval = 1s, .retry_interval = 500ms});
  store.full = true;
  for (std::uint32_t i = 0; i < 10; ++i) {
    sink.add(read_of(i));
    sink.update(kStart + i * 100ms);
  }
  EXPECT_EQ(sink.waiting(), 10U);
  EXPECT_TRUE(sink.failing_since());
  EXPECT_EQ(journal.count("disk full"), 1U) << "said once, not at every try";
  EXPECT_FALSE(sink.flush(kStart + 2s));
  store.full = false;
  EXPECT_TRUE(sink.flush(kStart + 3s));
  EXPECT_FALSE(sink.failing_since());
  EXPECT_EQ(sink.waiting(), 0U);
  EXPECT_EQ(store.items()->size(), 10U);
  EXPECT_EQ(store.last_batch(), 2U);
}

TEST(TagMemory, FadesAndForgetsWhatWasVisited) {
  TagMemory memory({.half_life_s = 10.0, .heard_at_m = 3.0, .visited_m = 1.5});
  const std::vector<reader::PortWeight> left = {{1, 0.0, 0.0}, {2, hal::kPi / 2, 8.0}};
  const std::vector<reader::PortWeight> nothing;
  memory.hear(pose(0.0, 0.0), left, kStart);
  EXPECT_NEAR(memory.pull_world(pose(0.0, 0.0)).y, 8.0, 1e-9);
  EXPECT_NEAR(memory.pull_world(pose(0.0, 90.0)).y, 8.0, 1e-9) << "a place in the world, not on the body";
  memory.hear(pose(0.0, 0.0), nothing, kStart + 10s);
  EXPECT_NEAR(memory.pull_world(pose(0.0, 0.0)).y, 4.0, 1e-9);
  hal::Pose there;
  there.position = {0.0, 2.0, 1.8};
  memory.hear(there, nothing, kStart + 10s);
  EXPECT_EQ(memory.pull_world(pose(0.0, 0.0)), hal::Vec3{});
}

TEST(TagMemory, ForgetsWhatLiesBehindABlockedHeading) {
  TagMemory memory({.half_life_s = 10.0});
  const std::vector<reader::PortWeight> both = {{1, 0.0, 5.0}, {2, hal::kPi / 2, 8.0}};
  memory.hear(pose(0.0, 0.0), both, kStart);
  memory.forget_towards(pose(0.0, 0.0), hal::kPi / 2, 0.3);
  EXPECT_NEAR(memory.pull_world(pose(0.0, 0.0)).x, 5.0, 1e-9);
  EXPECT_NEAR(memory.pull_world(pose(0.0, 0.0)).y, 0.0, 1e-9);
}

TEST(TagMemory, TheWeakestPlaceGivesWay) {
  TagMemory memory({.half_life_s = 1e9});
  for (int i = 0; i < 100; ++i) {
    const std::vector<reader::PortWeight> ahead = {{1, 0.0, 1.0 + i}};
    memory.hear(pose(10.0 * i, 0.0), ahead, kStart);
  }
  for (const TagMemory::Place& place : memory.places()) EXPECT_GT(place.weight, 60.0);
}

TEST(FlownPath, CountsTheWayButNotTheNoiseAndThinsItself) {
  FlownPath path(100, 0.1);
  hal::Random random(1);
  for (int i = 0; i < 5000; ++i) {
    hal::Pose here = pose(0.0, 0.0);
    here.position.x += 0.003 * random.normal();
    path.add(kStart, here);
  }
  EXPECT_EQ(path.length_m(), 0.0);
  for (int i = 0; i <= 2000; ++i) path.add(kStart + i * 50ms, pose(0.05 * i, 0.0));
  EXPECT_NEAR(path.length_m(), 100.0, 0.2);
  EXPECT_LE(path.points().size(), 100U);
  EXPECT_GE(path.points().size(), 50U);
  EXPECT_NEAR(path.points().back().pose_world.position.x, 100.0, 3.5);
}

}  // namespace
}  // namespace forager::flight
