#include "flight/drive_corridor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace forager::flight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(DriveCorridor, MeasuresFromTheWholePathNotFromItsPoints) {
  const auto corridor = DriveCorridor::create({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}}, 0.5);
  ASSERT_TRUE(corridor);
  EXPECT_DOUBLE_EQ(corridor->distance_m({2.0, 0.3, 7.0}), 0.3) << "heights do not matter";
  EXPECT_NEAR(corridor->distance_m({4.4, 1.5, 0.0}), 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(corridor->distance_m({-3.0, 4.0, 0.0}), 5.0) << "before its start";
  EXPECT_TRUE(corridor->contains({2.0, -0.5, 0.0}));
  EXPECT_FALSE(corridor->contains({2.0, -0.51, 0.0}));
}

TEST(DriveCorridor, APlaceNobodyKnowsIsOutside) {
  const auto corridor = DriveCorridor::create({{0, 0, 0}}, 0.5);
  ASSERT_TRUE(corridor);
  EXPECT_TRUE(corridor->contains({0.3, 0.0, 0.0}));
  EXPECT_FALSE(corridor->contains({kNan, 0.0, 0.0}));
}

TEST(DriveCorridor, RefusesWhatIsNoCorridor) {
  EXPECT_FALSE(DriveCorridor::create({}, 0.5));
  EXPECT_FALSE(DriveCorridor::create({{0, 0, 0}}, 0.0));
  EXPECT_FALSE(DriveCorridor::create({{0, 0, 0}}, kNan));
  EXPECT_FALSE(DriveCorridor::create({{kNan, 0, 0}}, 0.5));
}

}  // namespace
}  // namespace forager::flight
