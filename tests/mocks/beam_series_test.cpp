#include "mocks/beam_series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

double half_tangent_squared(double angle_rad) { return std::pow(std::tan(angle_rad / 2.0), 2); }

TEST(BeamSeries, CosineOfTheAngleWithoutACosine) {
  for (const double width_deg : {5.0, 35.0, 70.0, 89.0, 120.0, 179.0}) {
    const double width = hal::deg_to_rad(width_deg);
    const BeamSeries whole = cosine_beam_series(width, false, 0x1p-57);
    const BeamSeries split = cosine_beam_series(width, true, 0x1p-57);
    const double null = null_of_beam(width).w;
    for (double share = 0.0; share < 1.0; share += 0.01) {
      const double angle = share * std::min(width, hal::kPi / 2.0);
      const double w = half_tangent_squared(angle);
      const double exact = std::cos(hal::kPi / 2.0 * angle / width);
      EXPECT_NEAR(whole(w), exact, 2e-15) << width_deg << ' ' << share;
      EXPECT_NEAR(split(w) * (1.0 - w / null), exact, 2e-15) << width_deg << ' ' << share;
    }
    EXPECT_LE(split.error, 0x1p-57);
    EXPECT_EQ(split(0.0), 1.0);
  }
}

TEST(BeamSeries, TheNullIsKnownToTwiceThePrecision) {
  const double width = hal::deg_to_rad(70.0);
  const BeamNull null = null_of_beam(width);
  const long double exact = std::pow(std::tan(static_cast<long double>(width) / 2.0L), 2.0L);
  EXPECT_LE(std::abs(static_cast<double>(exact - null.w - null.rest)), 1e-18);
  EXPECT_LE(std::abs(null.rest), 0x1p-53 * null.w);
}

TEST(BeamSeries, SquareOfTheAngleForAGaussian) {
  const double width = hal::deg_to_rad(40.0);
  const BeamSeries series = gaussian_beam_series(width, 0x1p-57);
  for (double angle = 0.0; angle < hal::kPi / 2.0; angle += 0.01)
    EXPECT_NEAR(series(half_tangent_squared(angle)), 2.0 * std::pow(angle / width, 2), 2e-14) << angle;
}

TEST(BeamSeries, LessPrecisionTakesFewerTerms) {
  const double width = hal::deg_to_rad(70.0);
  EXPECT_LE(cosine_beam_series(width, true, 0x1p-28).terms, 10U);
  EXPECT_LE(cosine_beam_series(width, true, 0x1p-57).terms, 20U);
}

}  // namespace
}  // namespace forager::mocks
