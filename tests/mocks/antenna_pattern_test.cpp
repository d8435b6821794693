#include "mocks/antenna_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

using hal::deg_to_rad;
using hal::Vec3;

Vec3 direction(double azimuth_deg, double elevation_deg) {
  const double a = deg_to_rad(azimuth_deg);
  const double e = deg_to_rad(elevation_deg);
  return {2.0 * std::cos(a) * std::cos(e), 2.0 * std::sin(a) * std::cos(e), 2.0 * std::sin(e)};
}

TEST(AntennaPattern, IsOneOnBoresightAndHalfAtHalfTheBeamwidth) {
  const AntennaPattern pattern;
  EXPECT_DOUBLE_EQ(pattern.power({3.0, 0.0, 0.0}), 1.0);
  for (const double angle : {35.0, -35.0}) {
    EXPECT_NEAR(pattern.power(direction(angle, 0.0)), 0.5, 1e-12);
    EXPECT_NEAR(pattern.power(direction(0.0, angle)), 0.5, 1e-12);
  }
  EXPECT_NEAR(pattern.power(direction(35.0, 35.0)), 0.25, 1e-12);
}

TEST(AntennaPattern, IsExactlyZeroBeyondItsNullAndBehind) {
  const AntennaPattern pattern;
  // The bare cos^2 would give 0.188 at 90 degrees and 1 at 140.
  for (const double angle : {70.0001, 80.0, 89.0, 90.0, 100.0, 140.0, 180.0, -75.0, -120.0})
    EXPECT_EQ(pattern.power(direction(angle, 0.0)), 0.0) << angle;
  EXPECT_EQ(pattern.power(direction(0.0, 70.0001)), 0.0);
  EXPECT_EQ(pattern.power({0.0, 1.0, 0.0}), 0.0);
  EXPECT_EQ(pattern.power({-1.0, 0.0, 0.0}), 0.0);
  EXPECT_LT(pattern.power(direction(69.999, 0.0)), 1e-8);
}

// Without trigonometry, against libm: all forms, all the way to the null.
TEST(AntennaPattern, SeriesGiveThePowerOfTheFormula) {
  hal::Random random(4);
  for (const double width : {2.0, 30.0, 70.0, 90.0, 100.0, 150.0, 180.0})
    for (const bool cosine : {true, false}) {
      const double w = deg_to_rad(width);
      const AntennaPattern fast =
          cosine ? AntennaPattern::cosine_squared(w, 0.7 * w) : AntennaPattern::gaussian(w, w);
      const AntennaPattern exact = fast.with(PatternArithmetic::trigonometry);
      const AntennaPattern f32 = fast.with(PatternArithmetic::series_f32);
      double off = 0.0, off_f32 = 0.0;
      for (int i = 0; i < 3000; ++i) {
        const Vec3 p = direction(random.uniform(-1.2, 1.2) * width, random.uniform(-1.2, 1.2) * width);
        off = std::max(off, std::abs(fast.power(p) - exact.power(p)));
        off_f32 = std::max(off_f32, std::abs(f32.power(p) - exact.power(p)));
      }
      EXPECT_LE(off, 2e-15) << width << cosine;
      EXPECT_LE(off_f32, 1e-6) << width << cosine;
      EXPECT_GT(off_f32, 1e-9) << width << cosine;  // it really is single precision
    }
}

TEST(AntennaPattern, NeverGivesNaN) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const auto table = AntennaPattern::table({{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}, {{-1.0, 1.0}, {1.0, 1.0}});
  ASSERT_TRUE(table);
  for (const auto& pattern : {AntennaPattern(), AntennaPattern::gaussian(1.2, 1.2), *table,
                              AntennaPattern::cosine_squared(0.0, -1.0), AntennaPattern::gaussian(nan, 1.0),
                              AntennaPattern().with(PatternArithmetic::trigonometry),
                              AntennaPattern().with(PatternArithmetic::series_f32)}) {
    for (const double x : {0.0, -0.0, 1e-300, 1.0, inf, -inf, nan})
      for (const double y : {0.0, -0.0, 1e-300, 1.0, inf, -inf, nan})
        for (const double z : {0.0, 1e300, 1.0, inf, nan}) {
          const double p = pattern.power({x, y, z});
          EXPECT_TRUE(p >= 0.0 && p <= 1.0) << x << ' ' << y << ' ' << z << " -> " << p;
        }
  }
}

TEST(AntennaPattern, GaussianHalvesAtHalfTheBeamwidthAndIsZeroBehind) {
  const AntennaPattern pattern = AntennaPattern::gaussian(deg_to_rad(65.0), deg_to_rad(65.0));
  EXPECT_NEAR(pattern.power(direction(32.5, 0.0)), 0.5, 1e-12);
  EXPECT_NEAR(pattern.power(direction(65.0, 0.0)), 1.0 / 16.0, 1e-12);
  EXPECT_EQ(pattern.power({-1e-9, 1.0, 0.0}), 0.0);
}

TEST(AntennaPattern, TableInterpolatesAndCanHaveABackLobe) {
  const auto pattern = AntennaPattern::table(
      {{-hal::kPi, 0.1}, {-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, {hal::kPi, 0.1}}, {{-1.6, 1.0}, {1.6, 1.0}});
  ASSERT_TRUE(pattern);
  EXPECT_NEAR(pattern->power({std::cos(0.25), std::sin(0.25), 0.0}), 0.75, 1e-12);
  EXPECT_NEAR(pattern->power({-1.0, 0.0, 0.0}), 0.1, 1e-12);
  EXPECT_FALSE(AntennaPattern::table({{0.0, 1.0}}, {{-1.0, 1.0}, {1.0, 1.0}}));
  EXPECT_FALSE(AntennaPattern::table({{0.0, 1.0}, {0.0, 0.5}}, {{-1.0, 1.0}, {1.0, 1.0}}));
  EXPECT_FALSE(AntennaPattern::table({{0.0, 1.1}, {1.0, 0.5}}, {{-1.0, 1.0}, {1.0, 1.0}}));
}

}  // namespace
}  // namespace forager::mocks
