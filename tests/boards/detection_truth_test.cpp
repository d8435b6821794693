// The exact side of every comparison, held to values made with 298 bits (tests/data/detection/curve.csv).
#include "boards/detection_truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "hal/units.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using mocks::DetectionFormula;

TEST(DetectionTruth, TheCurveIsExactToAHundredBits) {
  std::ifstream file(test::data_path("detection/curve.csv"));
  std::string line;
  std::size_t rows = 0;
  while (std::getline(file, line)) {
    double x = 0.0, high = 0.0, low = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &x, &high, &low) != 3) continue;
    ++rows;
    const Wide off = exact_curve(x) - Wide(high, low);
    EXPECT_LE(std::abs(off.rounded()), 0x1p-94 * high) << x;
  }
  EXPECT_EQ(rows, 1024U);
}

TEST(DetectionTruth, ExponentialsOfWholeAndHalfNumbers) {
  EXPECT_EQ(exp2(Wide(10.0)).rounded(), 1024.0);
  EXPECT_EQ(exp2(Wide(-900.0)).rounded(), 0x1p-900);
  const Wide root = exp2(Wide(0.5));
  EXPECT_LE(std::abs((root * root - Wide(2.0)).rounded()), 1e-29);
}

TEST(DetectionTruth, TabulatedValuesOfThePaperAndThePlugin) {
  const double width = hal::deg_to_rad(70.0);
  const double edge = hal::deg_to_rad(35.0);
  const hal::Vec3 at_the_edge{3.0 * std::cos(edge), 3.0 * std::sin(edge), 0.0};
  EXPECT_NEAR(exact_detection({3.0, 0.0, 0.0}, {width, width, 3.0}), 0.5, 1e-15);
  EXPECT_NEAR(exact_detection({6.0, 0.0, 0.0}, {width, width, 3.0}), 0.2, 1e-15);
  EXPECT_NEAR(exact_detection(at_the_edge, {width, width, 3.0}), 0.349113, 5e-7);
  EXPECT_NEAR(exact_detection(at_the_edge, {width, width, 3.0, DetectionFormula::plugin}), 0.2, 1e-15);
  // Its range is that of the ground plan.
  const hal::Vec3 above{3.0, 0.0, 1.0};
  EXPECT_GT(exact_detection(above, {width, width, 3.0, DetectionFormula::plugin_as_published}),
            exact_detection(above, {width, width, 3.0, DetectionFormula::plugin}));
}

TEST(DetectionTruth, NothingBehindAndBeyondTheNull) {
  const double width = hal::deg_to_rad(70.0);
  for (const double angle : {70.001, 90.0, 140.0, 180.0}) {
    const double a = hal::deg_to_rad(angle);
    EXPECT_EQ(exact_detection({std::cos(a), std::sin(a), 0.0}, {width, width, 3.0}), 0.0) << angle;
  }
  EXPECT_EQ(exact_detection({0.0, 0.0, 0.0}, {width, width, 3.0}), 0.0);
  EXPECT_EQ(exact_normalised_range({-1.0, 0.0, 0.0}, {width, width, 3.0}).high,
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace forager::boards
