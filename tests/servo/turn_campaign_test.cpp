// Ten million targets (fewer with sanitizers) from 1e-12 to 1e6 m, half tracks from 0.05 to 5 m, through the
// planner and through the movements to 100 bits.
#include <gtest/gtest.h>

#include <array>

#include "boards/planner_truth.hpp"

namespace forager::servo {
namespace {

TEST(TurnCampaign, EveryTargetIsMetWithin1e12OfItsDistance) {
  hal::Random random(20261122);
  std::array<double, 4> worst{};
  long failures = 0;
  for (unsigned i = 0; i < FORAGER_PLANNER_TARGETS; ++i) {
    const double r = boards::any_half_track_m(random);
    const Target target = boards::hard_target(random, i, r);
    const auto plan = plan_turn_then_drive(target, {.half_track_m = r});
    ASSERT_TRUE(plan.has_value());
    const double distance_m = boards::distance_m(target);
    for (const TurnThenDrive* way : {&plan->left, &plan->right}) {
      const double relative = boards::miss_m(*way, r, target, boards::Rests::with) / distance_m;
      const bool sound = way->turn_rad >= 0.0 && way->turn_rad <= 2.0 * hal::kPi && way->drive_m >= 0.0 &&
                         way->roll_first_m >= 0.0 && relative <= 1e-12;  // false for NaN, too
      if (!sound && ++failures <= 5)
        ADD_FAILURE() << "r " << r << ", target (" << target.x_m << ", " << target.y_m << "), "
                      << to_string(way->brake) << ": turn " << way->turn_rad << ", drive " << way->drive_m
                      << ", off by " << relative;
      // The family of targets straight ahead is as good as the band that spares their turn: 1e-12.
      if (way->turn_rad > 0.0) worst[i % 4] = std::max(worst[i % 4], relative);
    }
    ASSERT_EQ(plan->no_way, NoWay::none);
  }
  EXPECT_EQ(failures, 0);
  for (const double family : worst) EXPECT_LT(family, 3e-15);
  RecordProperty("worst_relative",
                 std::to_string(*std::max_element(worst.begin(), worst.end()) * 1e15) + "e-15");
}

// The three doubles alone, as a controller takes them.
TEST(TurnCampaign, WithoutTheRestsFarTargetsKeepTheBoundAndNearOnesAnAbsoluteOne) {
  hal::Random random(20261123);
  for (unsigned i = 0; i < FORAGER_PLANNER_TARGETS / 20; ++i) {
    const double r = boards::any_half_track_m(random);
    const Target target = boards::hard_target(random, i, r);
    const auto plan = plan_turn_then_drive(target, {.half_track_m = r});
    ASSERT_TRUE(plan.has_value());
    const double distance_m = boards::distance_m(target);
    for (const TurnThenDrive* way : {&plan->left, &plan->right})
      ASSERT_LE(boards::miss_m(*way, r, target, boards::Rests::without),
                distance_m >= r / 500.0 ? 1e-12 * distance_m : 2e-15 * r)
          << "r " << r << ", target (" << target.x_m << ", " << target.y_m << ")";
  }
}

}  // namespace
}  // namespace forager::servo
