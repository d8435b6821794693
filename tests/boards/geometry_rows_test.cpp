// The geometry's rows of time against error, and its hard cases.
#include <gtest/gtest.h>

#include <algorithm>

#include "boards/accuracy_row.hpp"
#include "boards/planner_truth.hpp"
#include "boards/published_turn.hpp"
#include "boards/stress_case.hpp"

namespace forager::boards {
namespace {

AccuracyRow find(const std::vector<AccuracyRow>& rows, const std::string& name, const std::string& variant) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const AccuracyRow& row) {
    return row.name.find(name) != std::string::npos && row.variant.find(variant) == 0;
  });
  EXPECT_NE(found, rows.end()) << name << ", " << variant;
  return found == rows.end() ? AccuracyRow{} : *found;
}

TEST(GeometryRows, OurPlansEndOnTheirTargetsAndThePrintedOnesDoNot) {
  auto rows = accuracy_planner({.seed = 3, .effort = 0.01});
  for (const std::string name : {"within 10 m", "hard targets"}) {
    const AccuracyRow ours = find(rows, name, "closed form, f64 with rests");
    EXPECT_LE(ours.max_rel_error, 1e-12);
    EXPECT_EQ(ours.failures, 0U);
    const AccuracyRow published = find(rows, name, "as published");
    EXPECT_EQ(published.asked, ours.asked);
    EXPECT_GT(published.failures, published.asked * 99 / 100);
  }
  EXPECT_LE(find(rows, "within 10 m", "closed form, f64").max_rel_error, 1e-14);
  for (AccuracyRow& row : rows) {
    ASSERT_TRUE(row.work);
    row.work();
    EXPECT_GT(row.items, 0.0);
  }
}

// What the printed equations answer where they answer: 30 degrees are right, the drive is 29 % too long.
TEST(GeometryRows, ThePrintedDriveIsMeasuredFromTheWrongPoint) {
  const PublishedTurn printed = published_turn({1.0, 0.5});
  EXPECT_NEAR(printed.turn_rad, hal::kPi / 6, 1e-8);
  EXPECT_NEAR(printed.drive_m / std::sqrt(0.75), 1.29, 0.005);
  const PublishedTurn mended = published_turn({2.0, 1.0}, Reading::mended);
  EXPECT_NEAR(hal::rad_to_deg(mended.turn_rad), 28.0725, 5e-5);
  EXPECT_NEAR(mended.drive_m, 2.0, 1e-12);
  // Abreast of the wheel 6.5 divides by 0; almost straight ahead 6.8 as printed has no real root.
  EXPECT_TRUE(std::isnan(published_turn({1.0, 0.5}, Reading::mended).turn_rad));
  EXPECT_TRUE(std::isnan(published_turn({2.0, 0.1}).turn_rad));
}

TEST(GeometryRows, RelativePoseIsFoundForEveryAngle) {
  const auto rows = accuracy_relative_pose({.seed = 3, .effort = 0.01});
  for (const std::string name : {"true sightings", "5 cm off"}) {
    EXPECT_LE(find(rows, name, "atan2, f64").max_rel_error, 5e-16);
    EXPECT_EQ(find(rows, name, "atan2, f64").failures, 0U);
  }
  const AccuracyRow published = find(rows, "true sightings", "as published");
  EXPECT_NEAR(static_cast<double>(published.failures) / static_cast<double>(published.asked), 0.5, 0.08);
}

TEST(GeometryRows, TheGuardsTablesAreExactButForTheEdgeOfTheCorridor) {
  const auto rows = accuracy_guard({.seed = 3, .effort = 0.05});
  EXPECT_LE(find(rows, "aisle", "tables, f32").max_abs_error, 1e-6);
  EXPECT_LE(find(rows, "aisle", "tables, millimetres").max_abs_error, 1e-6);
  EXPECT_LE(find(rows, "edge", "tables, f32").max_abs_error, 0.03);  // a column of the image further
}

TEST(GeometryStress, EveryCaseHolds) {
  for (const StressCase& c : stress_geometry())
    EXPECT_TRUE(c.ok()) << c.name << ": " << c.worst << " > " << c.bound;
}

}  // namespace
}  // namespace forager::boards
