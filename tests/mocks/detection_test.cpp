#include "mocks/detection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>

#include "mocks/antenna_pattern.hpp"
#include "tests/places.hpp"

namespace forager::mocks {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const long double kLn3 = std::log(3.0L);

TEST(Detection, MeetsTheTabulatedProbabilities) {
  const struct {
    double u;
    double probability;
  } rows[] = {{0.0, 1.0}, {0.1, 0.945125}, {0.5, 0.732051}, {1.0, 0.5},
              {2.0, 0.2}, {3.0, 0.071429}, {5.0, 0.008197}};
  for (const auto& row : rows) EXPECT_NEAR(detection_probability(row.u), row.probability, 5e-7) << row.u;
}

TEST(Detection, AtTheHalfPowerEdgePaperAndPluginDiffer) {
  const AntennaPattern pattern;
  const double edge = hal::deg_to_rad(35.0);
  const double d0 = pattern.power({std::cos(edge), std::sin(edge), 0.0});
  EXPECT_NEAR(detection_probability(normalised_range(3.0, 3.0, d0)), 0.349113, 5e-7);
  EXPECT_NEAR(detection_probability(normalised_range(3.0, 3.0, d0, kPluginPatternExponent)), 0.2, 5e-7);
}

TEST(Detection, AgreesWithExtendedPrecisionDownToTheLastRepresentableTail) {
  for (double u = 1e-12; u < 640.0; u *= 1.037) {
    const long double t = static_cast<long double>(u) * kLn3;
    const long double probability = 2.0L / (1.0L + std::exp(t));
    // The same function twice: the logarithm loses its digits where tanh comes near 1.
    const long double exact = t > 1.0L ? 2.0L * std::atanh(std::exp(-t)) : -std::log(std::tanh(0.5L * t));
    const double bound = (6.0 + static_cast<double>(t)) * 0x1p-52;
    EXPECT_LE(std::abs(static_cast<double>(detection_probability(u) / probability - 1.0L)), bound) << u;
    EXPECT_LE(std::abs(static_cast<double>(expected_answers(u) / exact - 1.0L)), bound) << u;
  }
}

// tests/data/detection/curve.csv: 298 bits, kept to 105.
TEST(Detection, CompensatedStaysWithinTwoUlpOfTheExactCurve) {
  std::ifstream file(forager::test::data_path("detection/curve.csv"));
  std::string line;
  std::size_t rows = 0;
  double worst_ulp = 0.0;
  while (std::getline(file, line)) {
    double x = 0.0, high = 0.0, low = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &x, &high, &low) != 3) continue;
    ++rows;
    const double ulp = std::nextafter(high, 2.0) - high;
    worst_ulp = std::max(worst_ulp, std::abs((detection_probability_compensated(x) - high) - low) / ulp);
    // The rounding of sqrt(x) is half of what the plain way loses in the tail.
    EXPECT_NEAR(detection_probability(std::sqrt(x)) / high, 1.0, (5.0 + 2.2 * std::sqrt(x)) * 0x1p-52) << x;
  }
  EXPECT_EQ(rows, 1024U);
  EXPECT_LE(worst_ulp, 2.2);
  EXPECT_GT(worst_ulp, 0.5);  // below that, nothing was compared
}

TEST(Detection, CompensatedReachesTheEndsOfTheNumberRange) {
  EXPECT_EQ(detection_probability_compensated(0.0), 1.0);
  EXPECT_EQ(detection_probability_compensated(5e-324), 1.0);
  EXPECT_EQ(detection_probability_compensated(kInf), 0.0);
  EXPECT_EQ(detection_probability_compensated(kNaN), 0.0);
  EXPECT_EQ(detection_probability_compensated(-1.0), 0.0);
  EXPECT_EQ(detection_probability_compensated_u(1e308), 0.0);
  // 2 * 3^-677 is a denormal of some digits.
  EXPECT_NEAR(detection_probability_compensated_u(677.0) / std::ldexp(2.0 * std::exp2(-53.0196136), -1020),
              1.0, 1e-2);
  for (const double u : {0.1, 1.0, 7.3, 60.0})
    EXPECT_NEAR(detection_probability_compensated_u(u) / detection_probability_compensated(u * u), 1.0,
                1e-13);
}

TEST(Detection, ExpectedAnswersAndProbabilityAreTheSameThing) {
  for (const double u : {0.01, 0.1, 0.5, 1.0, 2.0, 5.0, 20.0})
    EXPECT_NEAR(answer_probability(expected_answers(u), 1.0) / detection_probability(u), 1.0, 1e-13) << u;
}

TEST(Detection, DoesNotDependOnTheTick) {
  const double hazard = expected_answers(3.0);
  for (const double tick : {0.01, 0.1, 1.0}) {
    const double missed_in_a_tick = std::log1p(-answer_probability(hazard, tick));
    EXPECT_NEAR(-std::expm1(missed_in_a_tick * (10.0 / tick)), answer_probability(hazard, 10.0), 1e-13)
        << tick;
  }
}

TEST(Detection, HasNoNaNAndNothingOutsideZeroToOne) {
  const double values[] = {0.0, -0.0, 5e-324, 1e-300, 1.0, 1e4, 1e300, -1.0, kInf, -kInf, kNaN};
  for (const double a : values) {
    EXPECT_GE(detection_probability(a), 0.0) << a;
    EXPECT_LE(detection_probability(a), 1.0) << a;
    EXPECT_GE(expected_answers(a), 0.0) << a;
    for (const double b : values) {
      const double p = answer_probability(a, b);
      EXPECT_TRUE(p >= 0.0 && p <= 1.0) << a << ' ' << b;
      for (const double c : values) EXPECT_GE(normalised_range(a, b, c), 0.0) << a << ' ' << b << ' ' << c;
    }
  }
}

TEST(Detection, WithoutPatternThereIsNoReading) {
  EXPECT_EQ(detection_probability(normalised_range(0.0, 3.0, 0.0)), 0.0);
  EXPECT_EQ(expected_answers(normalised_range(1.0, 3.0, 0.0)), 0.0);
  EXPECT_EQ(detection_probability(normalised_range(1.0, 0.0, 1.0)), 0.0);
  EXPECT_EQ(answer_probability(kInf, 0.01), 1.0);
}

}  // namespace
}  // namespace forager::mocks
