#include "servo/turn_then_drive.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "boards/planner_truth.hpp"

namespace forager::servo {
namespace {

using boards::distance_m;
using boards::miss_m;
using boards::Rests;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TurnPlan planned(Target target, const TurnConfig& config = {}) {
  auto plan = plan_turn_then_drive(target, config);
  EXPECT_TRUE(plan.has_value());
  return plan.value_or(TurnPlan{});
}

struct Case {
  Target target;
  Brake brake;
  double turn_deg;
  double drive_m;
};

// System figures for r = 0.5, to the digits they are printed with.
TEST(TurnThenDrive, WorkedExamples) {
  const double root_3 = std::sqrt(3.0);
  const std::vector<Case> cases = {
      {{1, 0}, Brake::none, 0, 1},
      {{1, 0.5}, Brake::left, 30, root_3 / 2},
      {{1, -0.5}, Brake::right, 30, root_3 / 2},
      {{2, 1}, Brake::left, 28.0725, 2},
      {{0.5, 0.5}, Brake::left, 90, 0},
      {{0, 1}, Brake::left, 180, 0},
      {{0, 0.99}, Brake::right, 289.6072, 1.4036},
      {{-1, 0}, Brake::left, 233.1301, 1},
      {{0.2, 0.2}, Brake::right, 329.323, 0.5292},
      {{1, 1e-12}, Brake::none, 0, 1},
  };
  for (const Case& c : cases) {
    const TurnThenDrive way = planned(c.target).chosen;
    EXPECT_EQ(way.brake, c.brake) << c.target.x_m << ", " << c.target.y_m;
    EXPECT_NEAR(hal::rad_to_deg(way.turn_rad), c.turn_deg, 5e-5) << c.target.x_m << ", " << c.target.y_m;
    EXPECT_NEAR(way.drive_m, c.drive_m, 5e-5) << c.target.x_m << ", " << c.target.y_m;
    EXPECT_FALSE(way.inside_circle);
    EXPECT_EQ(way.roll_first_m, 0.0);
  }
}

TEST(TurnThenDrive, WorkedExamplesWithRoundAnswersAreExact) {
  EXPECT_DOUBLE_EQ(planned({1, 0.5}).chosen.turn_rad, hal::kPi / 6);
  EXPECT_DOUBLE_EQ(planned({1, 0.5}).chosen.drive_m, std::sqrt(0.75));
  EXPECT_DOUBLE_EQ(planned({0.5, 0.5}).chosen.turn_rad, hal::kPi / 2);
  EXPECT_EQ(planned({0.5, 0.5}).chosen.drive_m, 0.0);
  EXPECT_DOUBLE_EQ(planned({0, 1}).chosen.turn_rad, hal::kPi);
  EXPECT_EQ(planned({0, 1}).chosen.drive_m, 0.0);
  EXPECT_EQ(planned({2, 1}).chosen.drive_m, 2.0);
  EXPECT_EQ(planned({1, 1e-12}).chosen.turn_rad, 0.0);
  EXPECT_EQ(planned({1, -1e-12}).chosen.turn_rad, 0.0);
}

TEST(TurnThenDrive, RightOfAnythingIsLeftMirrored) {
  const TurnPlan left = planned({1.3, 0.4});
  const TurnPlan right = planned({1.3, -0.4});
  EXPECT_EQ(left.chosen.turn_rad, right.chosen.turn_rad);
  EXPECT_EQ(left.left.turn_rad, right.right.turn_rad);
  EXPECT_EQ(left.right.turn_rad, right.left.turn_rad);
  EXPECT_GT(left.chosen.signed_turn_rad(), 0.0);
  EXPECT_LT(right.chosen.signed_turn_rad(), 0.0);
}

TEST(TurnThenDrive, InsideTheCircleTheOtherBrakeOrARollFirst) {
  const TurnPlan plan = planned({0.2, 0.2});
  EXPECT_TRUE(plan.left.inside_circle);
  EXPECT_FALSE(plan.right.inside_circle);
  EXPECT_NEAR(plan.left.roll_first_m, 0.6, 1e-15);  // to (-0.4, 0.2): on the circle around (0, 0.5)
  EXPECT_EQ(plan.left.drive_m, 0.0);
  EXPECT_NEAR(hal::rad_to_deg(plan.left.turn_rad), 306.8699, 5e-5);

  EXPECT_EQ(planned({0.2, 0.2}, {.roll_first = RollFirst::if_shorter_turn}).chosen.brake, Brake::left);
  EXPECT_EQ(planned({0.2, 0.2}, {.right_brake = false}).chosen, plan.left);
  EXPECT_EQ(planned({0.2, 0.2}, {.roll_first = RollFirst::never, .right_brake = false}).no_way,
            NoWay::inside_circle);
}

TEST(TurnThenDrive, OneBrakeIsEnoughToGetAnywhere) {
  const TurnPlan plan = planned({1, -0.5}, {.right_brake = false});
  EXPECT_EQ(plan.chosen.brake, Brake::left);
  EXPECT_LT(miss_m(plan.chosen, 0.5, {1, -0.5}, Rests::without), 1e-15);
}

TEST(TurnThenDrive, RefusesWithAReason) {
  EXPECT_EQ(planned({1, 0.5}, {.left_brake = false, .right_brake = false}).no_way, NoWay::no_brake);
  EXPECT_EQ(planned({-1, 0}, {.max_turn_rad = hal::kPi}).no_way, NoWay::turn_too_large);
  EXPECT_EQ(planned({1.7e308, 1.7e308}).no_way, NoWay::too_far);
  EXPECT_EQ(planned({1, 0}, {.max_turn_rad = 0.0, .left_brake = false, .right_brake = false}).no_way,
            NoWay::none);
}

TEST(TurnThenDrive, StandingOnTheTargetNothingMoves) {
  for (const Target target : {Target{0.0, 0.0}, Target{-0.0, 0.0}, Target{0.0, -0.0}})
    EXPECT_EQ(planned(target).chosen, TurnThenDrive{});
}

TEST(TurnThenDrive, AWideStraightBandSparesTheBrakes) {
  const TurnThenDrive way = planned({2.0, 0.019}, {.straight_band = 0.01}).chosen;
  EXPECT_EQ(way.brake, Brake::none);
  EXPECT_EQ(way.drive_m, 2.0);
  EXPECT_EQ(planned({2.0, 0.021}, {.straight_band = 0.01}).chosen.brake, Brake::left);
  EXPECT_NE(planned({-2.0, 0.001}, {.straight_band = 0.01}).chosen.turn_rad, 0.0);  // behind is not ahead
}

TEST(TurnThenDrive, WhatIsNoTargetOrNoVehicleIsAnError) {
  const auto code = [](Target target, double r) {
    const auto plan = plan_turn_then_drive(target, {.half_track_m = r});
    return plan ? hal::ErrorCode::io : plan.error().code;
  };
  for (const double bad : {kNaN, kInf, -kInf}) {
    EXPECT_EQ(code({bad, 0.0}, 0.5), hal::ErrorCode::invalid_argument);
    EXPECT_EQ(code({0.0, bad}, 0.5), hal::ErrorCode::invalid_argument);
    EXPECT_EQ(code({1.0, 0.0}, bad), hal::ErrorCode::invalid_argument);
  }
  for (const double r : {0.0, -0.0, -0.5, 1e-4, 1e4, 5e-324})
    EXPECT_EQ(code({1.0, 0.0}, r), hal::ErrorCode::invalid_argument);
  EXPECT_FALSE(plan_turn_then_drive({1, 1}, {.straight_band = kNaN}));
  EXPECT_FALSE(plan_turn_then_drive({1, 1}, {.max_turn_rad = 7.0}));
}

TEST(TurnThenDrive, NeitherOverflowsNorUnderflows) {
  // Far from everything the circle is a point: the turn is the bearing.
  const TurnThenDrive far = planned({1e300, -1e300}).chosen;
  EXPECT_DOUBLE_EQ(far.turn_rad, hal::kPi / 4);
  EXPECT_DOUBLE_EQ(far.drive_m, std::sqrt(2.0) * 1e300);
  EXPECT_EQ(planned({5e-324, 0.0}).chosen.drive_m, 5e-324);
  // Beside the wheel, D = sqrt(2 r Y).
  const TurnThenDrive near = planned({0.0, -1e-300}).chosen;
  EXPECT_EQ(near.brake, Brake::left);
  EXPECT_DOUBLE_EQ(near.drive_m, 1e-150);
}

// One unit in the last place decides on which side of the circle a target is; both sides stay defined.
TEST(TurnThenDrive, OnTheCircleAndOneUnitBesideIt) {
  for (const double bearing : {-1.5, -0.7, 0.0, 0.3, 1.0, 1.5, 2.0, 3.0}) {
    const Target on{0.5 * std::cos(bearing), 0.5 + 0.5 * std::sin(bearing)};
    for (const double toward : {-kInf, kInf}) {
      const Target beside{std::nextafter(on.x_m, toward), on.y_m};
      const TurnPlan plan = planned(beside);
      EXPECT_LT(miss_m(plan.left, 0.5, beside, Rests::with), 1e-12 * distance_m(beside));
      EXPECT_LT(plan.left.drive_m, 1e-7);
    }
  }
}

// Any plan ends where it should, the other brake's too; the turn is the smaller of both.
RC_GTEST_PROP(TurnThenDriveProperty, BothWaysEndOnTheTarget, (std::uint64_t seed)) {
  hal::Random random(seed);
  for (unsigned i = 0; i < 8; ++i) {
    const double r = boards::any_half_track_m(random);
    const Target target = boards::hard_target(random, i, r);
    const auto plan = plan_turn_then_drive(target, {.half_track_m = r});
    RC_ASSERT(plan.has_value());
    for (const TurnThenDrive& way : {plan->left, plan->right, plan->chosen})
      RC_ASSERT(miss_m(way, r, target, Rests::with) <= 1e-12 * distance_m(target));
    RC_ASSERT(plan->left.inside_circle + plan->right.inside_circle <= 1);
    if (!plan->left.inside_circle) RC_ASSERT(plan->chosen.turn_rad <= plan->left.turn_rad);
    if (!plan->right.inside_circle) RC_ASSERT(plan->chosen.turn_rad <= plan->right.turn_rad);
  }
}

// Geometry has no unit of length: twice the vehicle and twice the way is the same turn.
RC_GTEST_PROP(TurnThenDriveProperty, ScalesWithTheVehicle, (std::uint64_t seed)) {
  hal::Random random(seed);
  const Target target = boards::hard_target(random, static_cast<unsigned>(seed % 4), 0.5);
  const TurnThenDrive one = planned(target, {.half_track_m = 0.5}).chosen;
  const TurnThenDrive two = planned({2 * target.x_m, 2 * target.y_m}, {.half_track_m = 1.0}).chosen;
  RC_ASSERT(one.turn_rad == two.turn_rad);
  RC_ASSERT(2 * one.drive_m == two.drive_m);
}

}  // namespace
}  // namespace forager::servo
