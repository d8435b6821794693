#include "flight/hop_planner.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flight/ground_detour.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

// A bar across the way, `height` above the floor.
HopObstacle bar(double x, double height, double half_length = 2.0, double half_depth = 0.1) {
  return {{x, 0.0, 0.0}, half_depth, half_length, 0.0, height};
}

HopPlan ahead(double length, std::vector<HopObstacle> obstacles, HopLimits limits = {}) {
  return plan_hops({}, {length, 0.0, 0.0}, obstacles, limits);
}

TEST(HopPlanner, HopsOverABarWithItsMargins) {
  const HopPlan plan = ahead(6.0, {bar(3.0, 0.3)});
  ASSERT_EQ(plan.reason, HopReason::hop) << plan.detail;
  ASSERT_EQ(plan.hops.size(), 1U);
  const Hop& hop = plan.hops[0];
  EXPECT_NEAR(hop.takeoff_world.x, 2.9 - 0.65 - 0.30, 1e-12);
  EXPECT_NEAR(hop.landing_world.x, 3.1 + 0.65 + 0.40, 1e-12);
  EXPECT_NEAR(hop.climb_m, 0.3 + 0.4, 1e-12);
  EXPECT_NEAR(hop.length_m, 2.2, 1e-12);
  EXPECT_EQ(hop.yaw_rad, 0.0);
}

TEST(HopPlanner, RollsWhereNothingStandsInTheStrip) {
  EXPECT_EQ(ahead(6.0, {}).reason, HopReason::free);
  HopObstacle beside = bar(3.0, 0.3, 0.2);
  beside.centre_world.y = 0.2 + 0.85 + 1e-6;
  EXPECT_EQ(ahead(6.0, {beside}).reason, HopReason::free);
  beside.centre_world.y -= 2e-6;
  EXPECT_EQ(ahead(6.0, {beside}).reason, HopReason::hop) << "it reaches a hair into the strip";
  EXPECT_EQ(ahead(6.0, {bar(-1.0, 9.0)}).reason, HopReason::free) << "behind";
  EXPECT_EQ(ahead(6.0, {bar(7.2, 9.0)}).reason, HopReason::free) << "beyond the goal";
}

TEST(HopPlanner, SaysWhyNot) {
  HopObstacle unknown = bar(3.0, 0.0);
  unknown.height_m.reset();
  EXPECT_EQ(ahead(6.0, {unknown}).reason, HopReason::height_unknown);
  EXPECT_EQ(ahead(6.0, {bar(3.0, 1.3)}).reason, HopReason::too_high);
  EXPECT_EQ(ahead(6.0, {bar(0.8, 0.3)}).reason, HopReason::too_near);
  EXPECT_EQ(ahead(4.0, {bar(3.0, 0.3)}).reason, HopReason::no_landing);
  EXPECT_EQ(ahead(20.0, {bar(8.0, 0.3, 2.0, 3.0)}).reason, HopReason::too_long);
  HopLimits low;
  low.ceiling_m = 1.4;
  EXPECT_EQ(ahead(6.0, {bar(3.0, 0.3)}, low).reason, HopReason::no_headroom);
  EXPECT_EQ(ahead(6.0, {{{std::nan(""), 0.0, 0.0}, 1.0, 1.0, 0.0, 1.0}}).reason, HopReason::invalid);
  EXPECT_EQ(plan_hops({1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}, {}, {}).reason, HopReason::invalid);
  for (const auto& plan : {ahead(6.0, {unknown}), ahead(6.0, {bar(3.0, 1.3)})}) {
    EXPECT_TRUE(plan.hops.empty());
    EXPECT_NE(plan.detail.find("obstacle 1"), std::string::npos) << plan.detail;
  }
}

TEST(HopPlanner, TakesOffWhereItStandsIfItIsJustFarEnough) {
  const HopPlan plan = ahead(6.0, {bar(1.0, 0.3)});  // begins 0.90 m ahead; 0.85 m are needed
  ASSERT_EQ(plan.reason, HopReason::hop) << plan.detail;
  EXPECT_EQ(plan.hops[0].takeoff_world.x, 0.0);
}

TEST(HopPlanner, OneHopOverObstaclesWithNoPlaceToLandBetween) {
  const HopPlan near = ahead(9.0, {bar(3.0, 0.3), bar(4.5, 0.6)});
  ASSERT_EQ(near.reason, HopReason::hop) << near.detail;
  ASSERT_EQ(near.hops.size(), 1U);
  EXPECT_NEAR(near.hops[0].climb_m, 1.0, 1e-12) << "the higher of the two";
  const HopPlan far = ahead(12.0, {bar(8.0, 0.6), bar(3.0, 0.3)});
  ASSERT_EQ(far.hops.size(), 2U) << "in the order of the way";
  EXPECT_LT(far.hops[0].landing_world.x, far.hops[1].takeoff_world.x);
  EXPECT_NEAR(far.hops[0].climb_m, 0.7, 1e-12);
}

TEST(HopPlanner, AHiddenLongerObstacleMovesTheLanding) {
  // The second begins inside the first and ends far behind it.
  const HopPlan plan = ahead(9.0, {bar(3.0, 0.3, 2.0, 0.5), bar(4.0, 0.2, 2.0, 1.2)});
  ASSERT_EQ(plan.hops.size(), 1U) << plan.detail;
  EXPECT_NEAR(plan.hops[0].landing_world.x, 5.2 + 1.05, 1e-12);
}

// Every hop keeps the body clear of every obstacle: sampled along its way, against the true distance to the
// box, wherever the way and the boxes lie.
RC_GTEST_PROP(HopPlanner, NoPlannedWayTouchesAnything, (std::uint64_t seed)) {
  hal::Random random(seed);
  const hal::Vec3 from{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), 0.0};
  const double yaw = random.uniform(-hal::kPi, hal::kPi);
  const double length = random.uniform(2.0, 14.0);
  const hal::Vec3 to = from + hal::rotate_yaw({length, 0.0, 0.0}, yaw);
  std::vector<HopObstacle> obstacles;
  for (std::uint64_t i = random.below(4); i > 0; --i)
    obstacles.push_back(
        {from + hal::rotate_yaw({random.uniform(-1.0, length), random.uniform(-2.5, 2.5), 0.0}, yaw),
         random.uniform(0.05, 0.8), random.uniform(0.05, 1.5), random.uniform(-4.0, 4.0),
         random.uniform(0.05, 1.0)});
  const HopLimits limits;
  const HopPlan plan = plan_hops(from, to, obstacles, limits);
  if (!plan.passable()) {
    RC_ASSERT(!plan.detail.empty());
    return;
  }
  const auto distance = [](hal::Vec3 p, const HopObstacle& o) {
    const hal::Vec3 l = hal::rotate_yaw(p - o.centre_world, -o.yaw_rad);
    return std::hypot(std::max(std::abs(l.x) - o.half_x_m, 0.0), std::max(std::abs(l.y) - o.half_y_m, 0.0));
  };
  for (double s = 0.0; s <= length; s += 0.02) {
    const hal::Vec3 at = from + hal::rotate_yaw({s, 0.0, 0.0}, yaw);
    const Hop* over = nullptr;
    for (const Hop& hop : plan.hops)
      if (s > hal::distance_xy(from, hop.takeoff_world) && s < hal::distance_xy(from, hop.landing_world))
        over = &hop;
    for (const HopObstacle& o : obstacles) {
      const auto span = span_on_way(from, to, o, limits.body_radius_m + limits.side_margin_m);
      if (!span || span->end_m <= 0.0) continue;  // behind, or beside
      if (over != nullptr)
        RC_ASSERT(distance(at, o) > limits.body_radius_m ||
                  *o.height_m + limits.height_margin_m <= over->climb_m + 1e-9);
      else
        RC_ASSERT(distance(at, o) >= limits.body_radius_m - 1e-9);
    }
  }
}

TEST(GroundDetour, GoesStraightWhereItCan) {
  const auto way = ground_detour({}, {5.0, 0.0, 0.0}, {}, 0.85, {});
  ASSERT_TRUE(way);
  EXPECT_EQ(way->size(), 2U);
}

TEST(GroundDetour, GoesRoundTheShorterEnd) {
  HopObstacle wall = bar(3.0, 1.0, 1.0);
  wall.centre_world.y = -0.4;
  const auto way = ground_detour({}, {6.0, 0.0, 0.0}, std::vector{wall}, 0.85, {});
  ASSERT_TRUE(way);
  ASSERT_EQ(way->size(), 4U);
  EXPECT_NEAR((*way)[1].y, 0.6 + 0.85, 1e-5) << "round its upper end";
  double length = 0.0;
  for (std::size_t i = 1; i < way->size(); ++i) length += hal::distance_xy((*way)[i - 1], (*way)[i]);
  EXPECT_NEAR(length, 2.0 * std::hypot(2.05, 1.45) + 1.9, 1e-4);
}

TEST(GroundDetour, FindsNoWayThroughAClosedCorridor) {
  const GroundArea corridor{-1.0, -1.5, 10.0, 1.5};
  EXPECT_FALSE(ground_detour({}, {6.0, 0.0, 0.0}, std::vector{bar(3.0, 0.3)}, 0.85, corridor));
  EXPECT_FALSE(ground_detour({}, {3.0, 0.0, 0.0}, std::vector{bar(3.0, 0.3)}, 0.85, {})) << "inside it";
  EXPECT_FALSE(ground_detour({}, {20.0, 0.0, 0.0}, {}, 0.85, corridor)) << "outside the area";
}

RC_GTEST_PROP(GroundDetour, KeepsItsDistanceAndIsNoLongerThanNeeded, (std::uint64_t seed)) {
  hal::Random random(seed);
  std::vector<HopObstacle> obstacles;
  for (int i = 0; i < 4; ++i)
    obstacles.push_back({{random.uniform(1.5, 8.5), random.uniform(-3.0, 3.0), 0.0},
                         random.uniform(0.1, 0.8),
                         random.uniform(0.1, 0.8),
                         random.uniform(-4.0, 4.0),
                         1.0});
  const double half_width = 0.5;
  const hal::Vec3 from{-1.5, 0.0, 0.0};
  const hal::Vec3 to{11.5, 0.0, 0.0};
  const auto way = ground_detour(from, to, obstacles, half_width, {});
  RC_ASSERT(way.has_value());
  double length = 0.0;
  for (std::size_t i = 1; i < way->size(); ++i) {
    const hal::Vec3 step = (*way)[i] - (*way)[i - 1];
    length += std::hypot(step.x, step.y);
    for (int k = 0; k <= 50; ++k) {
      const hal::Vec3 at = (*way)[i - 1] + (k / 50.0) * step;
      for (const HopObstacle& o : obstacles) {
        const hal::Vec3 l = hal::rotate_yaw(at - o.centre_world, -o.yaw_rad);
        RC_ASSERT(std::hypot(std::max(std::abs(l.x) - o.half_x_m, 0.0),
                             std::max(std::abs(l.y) - o.half_y_m, 0.0)) >= half_width - 1e-6);
      }
    }
  }
  RC_ASSERT(length >= 13.0 - 1e-9);
  RC_ASSERT(length <= 13.0 + 2.0 * (3.0 + 0.8 * 1.5 + half_width * 1.5) + 4.0);
}

}  // namespace
}  // namespace forager::flight
