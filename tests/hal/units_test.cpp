#include "hal/units.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

namespace forager::hal {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(WrapPi, KeepsTheUpperEndAndMovesTheLowerOne) {
  EXPECT_EQ(kPi, wrap_pi(kPi));
  EXPECT_EQ(kPi, wrap_pi(-kPi));
  EXPECT_EQ(kPi, wrap_pi(3.0 * kPi));
  EXPECT_EQ(kPi, wrap_pi(-3.0 * kPi));
  EXPECT_EQ(std::nextafter(-kPi, 0.0), wrap_pi(std::nextafter(-kPi, 0.0)));
  EXPECT_LT(wrap_pi(std::nextafter(kPi, 4.0)), -3.14);
}

// Exact remainder of 1e22 by the double next to 2 pi, by rational arithmetic.
TEST(WrapPi, IsExactForHugeAngles) {
  EXPECT_DOUBLE_EQ(1.0634318162761502, wrap_pi(1e22));
  EXPECT_DOUBLE_EQ(-1.0634318162761502, wrap_pi(-1e22));
}

TEST(WrapPi, HasNoAnswerForNoAngle) {
  EXPECT_TRUE(std::isnan(wrap_pi(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(wrap_pi(kInfinity)));
  EXPECT_TRUE(std::isnan(wrap_pi(-kInfinity)));
}

RC_GTEST_PROP(WrapPi, IsIdempotentHalfOpenAndKeepsTheDirection, (int millirad)) {
  const double angle = 0.001 * millirad;
  const double wrapped = wrap_pi(angle);
  RC_ASSERT(wrapped > -kPi);
  RC_ASSERT(wrapped <= kPi);
  RC_ASSERT(wrap_pi(wrapped) == wrapped);
  RC_ASSERT(std::abs(std::cos(wrapped) - std::cos(angle)) < 1e-9);
  RC_ASSERT(std::abs(std::sin(wrapped) - std::sin(angle)) < 1e-9);
}

TEST(AngleDifference, TakesTheShortWayAcrossTheSeam) {
  EXPECT_NEAR(deg_to_rad(-2.0), angle_difference(deg_to_rad(179.0), deg_to_rad(-179.0)), 1e-12);
  EXPECT_NEAR(deg_to_rad(2.0), angle_difference(deg_to_rad(-179.0), deg_to_rad(179.0)), 1e-12);
  EXPECT_NEAR(deg_to_rad(90.0), angle_difference(deg_to_rad(90.0), 0.0), 1e-12);
}

TEST(Degrees, ConvertThereAndBack) {
  EXPECT_DOUBLE_EQ(kPi / 2.0, deg_to_rad(90.0));
  EXPECT_DOUBLE_EQ(-180.0, rad_to_deg(-kPi));
}

}  // namespace
}  // namespace forager::hal
