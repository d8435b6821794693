#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "flight/baseline_dead_reckoning.hpp"
#include "flight/baseline_random_walk.hpp"
#include "flight/baseline_static.hpp"
#include "flight/baseline_stop_and_rotate.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

// Obeys a policy in an empty hall, or before walls the test puts up; time passes as steps and windows take.
struct Walker {
  Policy& policy;
  hal::Pose pose = {};
  hal::Duration elapsed{};
  Step step = {};
  bool blocked = false;
  double moved = 0.0;
  std::uint32_t fresh = 0;

  void begin() { step = policy.begin(pose); }
  void next(bool way_free = true) {
    elapsed += step.listen;
    Observation seen;
    seen.now = hal::Instant(elapsed);
    seen.elapsed = elapsed;
    seen.pose_world = pose;
    seen.fresh_tags = fresh;
    seen.blocked = blocked;
    seen.moved_m = moved;
    seen.way_ahead = way_free ? WayAhead::clear : WayAhead::blocked;
    step = policy.decide(seen);
    pose.yaw_rad = step.heading_rad;
    blocked = step.length_m > 0.0 && !way_free;
    moved = blocked ? 0.0 : step.length_m;
    pose.position = pose.position + moved * hal::Vec3{std::cos(pose.yaw_rad), std::sin(pose.yaw_rad), 0.0};
    if (step.speed_m_s > 0.0) elapsed += hal::from_seconds(moved / step.speed_m_s);
  }
};

TEST(Static, HoversForTheMissionTimeThenLands) {
  Static policy({.mission_time = 25s, .window = 2s, .height_m = 1.8});
  Walker walker{policy};
  walker.begin();
  while (walker.step.kind != DecisionKind::land && walker.elapsed < 60s) {
    walker.next();
    EXPECT_EQ(walker.step.length_m, 0.0);
    EXPECT_EQ(walker.step.height_m, 1.8);
  }
  EXPECT_EQ(walker.elapsed, 25s);
  EXPECT_EQ(walker.step.end, EndReason::time_limit);
}

TEST(DeadReckoning, FliesItsPathOnceAtItsSpeed) {
  DeadReckoning policy({.waypoints_world = {{4, 0, 0}, {4, 3, 0}}, .height_m = 1.8, .speed_m_s = 0.25});
  Walker walker{policy};
  walker.begin();
  walker.next();
  EXPECT_EQ(walker.step.kind, DecisionKind::forward);
  EXPECT_NEAR(walker.pose.position.x, 4.0, 1e-9);
  walker.next();
  EXPECT_EQ(walker.step.kind, DecisionKind::turn_left);
  EXPECT_NEAR(walker.pose.position.y, 3.0, 1e-9);
  walker.next();
  EXPECT_EQ(walker.step.end, EndReason::path_complete);
  EXPECT_NEAR(hal::to_seconds(walker.elapsed), 7.0 / 0.25, 1e-6);
}

TEST(DeadReckoning, WaitsBeforeAWallThenGivesTheWaypointUp) {
  DeadReckoning policy({.waypoints_world = {{4, 0, 0}}, .patience = 5, .wait = 2s});
  Walker walker{policy};
  walker.begin();
  for (int i = 0; i < 30 && walker.step.kind != DecisionKind::land; ++i) walker.next(false);
  EXPECT_EQ(walker.step.kind, DecisionKind::land);
  EXPECT_EQ(walker.pose.position, hal::Vec3{});

  DeadReckoning patient({.waypoints_world = {{4, 0, 0}}, .patience = 5, .wait = 2s});
  Walker lucky{patient};
  lucky.begin();
  lucky.next(false);
  lucky.next(false);
  for (int i = 0; i < 5 && lucky.step.kind != DecisionKind::land; ++i) lucky.next(true);
  EXPECT_NEAR(lucky.pose.position.x, 4.0, 1e-9) << "the obstacle walked away";
}

TEST(StopAndRotate, ThresholdsStartAndEndARotation) {
  StopAndRotate policy({.rotate_above = 10, .rotate_below = 3, .height_m = 1.0});
  Walker walker{policy};
  walker.begin();
  walker.fresh = 10;
  walker.next();
  EXPECT_NEAR(walker.step.length_m, 0.75, 1e-9) << "10 is not above 10: three seconds at 0.25 m/s";
  walker.fresh = 11;
  walker.next();
  EXPECT_EQ(walker.step.length_m, 0.0);
  EXPECT_NEAR(walker.step.heading_rad, hal::deg_to_rad(60.0), 1e-9);
  walker.fresh = 3;
  walker.next();
  EXPECT_NEAR(walker.step.heading_rad, hal::deg_to_rad(120.0), 1e-9) << "3 is not below 3: it rotates on";
  walker.fresh = 2;
  walker.next();
  EXPECT_NEAR(walker.step.heading_rad, 0.0, 1e-9) << "back on its course";
  EXPECT_NEAR(walker.step.length_m, 0.75, 1e-9);
}

TEST(StopAndRotate, TurnsAwayFromAWallAndLandsWhenNothingIsNew) {
  StopAndRotate policy({.tries = 4});
  Walker walker{policy};
  walker.begin();
  walker.fresh = 1;
  walker.next(false);
  walker.next(true);
  EXPECT_NEAR(walker.step.heading_rad, hal::deg_to_rad(90.0), 1e-9);
  walker.fresh = 0;
  for (int i = 0; i < 4; ++i) walker.next();
  EXPECT_EQ(walker.step.end, EndReason::no_new_tags);
}

TEST(RandomWalk, RepeatsFromItsSeedAndCoversAllDirections) {
  RandomWalk first({.seed = 3, .mission_time = 400s});
  RandomWalk second({.seed = 3, .mission_time = 400s});
  RandomWalk other({.seed = 4, .mission_time = 400s});
  Walker a{first}, b{second}, c{other};
  a.begin();
  b.begin();
  c.begin();
  std::set<int> quadrants;
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    a.next();
    b.next();
    c.next();
    EXPECT_EQ(a.step.heading_rad, b.step.heading_rad);
    differs |= a.step.heading_rad != c.step.heading_rad;
    quadrants.insert(static_cast<int>(std::floor(a.step.heading_rad / (hal::kPi / 2))));
  }
  EXPECT_TRUE(differs);
  EXPECT_EQ(quadrants.size(), 4U);
  for (int i = 0; i < 200 && a.step.kind != DecisionKind::land; ++i) a.next();
  EXPECT_EQ(a.step.end, EndReason::time_limit);
}

}  // namespace
}  // namespace forager::flight
