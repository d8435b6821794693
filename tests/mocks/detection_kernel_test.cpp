// Probability of detection, many tags at a time and without trigonometry, against the formula evaluated in
// extended precision, and against itself on other vector widths.
#include "mocks/detection_kernel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "hal/random.hpp"
#include "mocks/detection.hpp"

namespace forager::mocks {
namespace {

using hal::deg_to_rad;
using Exact = long double;

constexpr double kR0 = 2.4;

// Equations 4.1 and 4.3 of the thesis as written, with true nulls; or those of the published plugin.
Exact exact_probability(Exact x, Exact y, Exact z, Exact width, DetectionFormula formula, Exact r0) {
  if (!(x > 0.0L)) return 0.0L;
  const bool published = formula == DetectionFormula::plugin_as_published;
  const Exact planar = std::hypot(x, y);
  const Exact h = std::abs(std::atan2(y, x));
  const Exact v = std::abs(std::atan2(z, published ? x : planar));
  if (h >= width || v >= width) return 0.0L;
  const Exact half_pi = std::numbers::pi_v<Exact> / 2.0L;
  const Exact amplitude = std::cos(half_pi * h / width) * std::cos(half_pi * v / width);
  const Exact shape = formula == DetectionFormula::paper ? amplitude : amplitude * amplitude;
  const Exact t = (published ? planar : std::hypot(planar, z)) / (r0 * shape) * std::log(3.0L);
  return 2.0L * std::exp(-t) / (1.0L + std::exp(-t));
}

template <class T>
struct Points {
  std::vector<T> x, y, z, p;
  explicit Points(std::size_t count, double reach_m = 8.0, std::uint64_t seed = 1) : p(count) {
    hal::Random random(seed);
    for (auto* axis : {&x, &y, &z}) axis->resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      x[i] = static_cast<T>(random.uniform(-0.2 * reach_m, reach_m));
      y[i] = static_cast<T>(random.uniform(-reach_m, reach_m));
      z[i] = static_cast<T>(random.uniform(-reach_m, reach_m));
    }
  }
  void run(const DetectionKernel& kernel, std::span<const T> r0_factor = {}) {
    kernel.probabilities(x, y, z, std::span<T>(p), r0_factor);
  }
};

DetectionKernel kernel_of(double width_deg, DetectionFormula formula, double cut = 0.0) {
  const double width = deg_to_rad(width_deg);
  return DetectionKernel({AntennaPattern::cosine_squared(width, width), kR0, formula, cut});
}

constexpr DetectionFormula kFormulas[] = {DetectionFormula::paper, DetectionFormula::plugin,
                                          DetectionFormula::plugin_as_published};

TEST(DetectionKernel, MeetsTheExactFormulaForEveryWidthAndVariant) {
  Points<double> points(4001);
  Points<float> floats(4001);
  for (const double width : {3.0, 20.0, 45.0, 70.0, 90.0, 90.001, 120.0, 180.0})
    for (const DetectionFormula formula : kFormulas) {
      const DetectionKernel kernel = kernel_of(width, formula);
      points.run(kernel);
      floats.run(kernel);
      double off[4] = {};
      const auto note = [&](int which, Exact value, Exact exact) {
        off[which] = std::max(off[which], static_cast<double>(std::abs(value - exact)));
      };
      for (std::size_t i = 0; i < points.x.size(); ++i) {
        const hal::Vec3 p{points.x[i], points.y[i], points.z[i]};
        const Exact exact = exact_probability(p.x, p.y, p.z, deg_to_rad(width), formula, kR0);
        note(0, points.p[i], exact);
        note(1, kernel.probability(p), exact);
        note(2, kernel.reference(p), exact);
        note(3, floats.p[i],
             exact_probability(floats.x[i], floats.y[i], floats.z[i], deg_to_rad(width), formula, kR0));
      }
      SCOPED_TRACE(testing::Message() << width << " degrees, " << to_string(formula));
      EXPECT_LE(off[0], 1e-15);
      EXPECT_LE(off[1], 1e-15);
      EXPECT_LE(off[2], 1e-15);
      EXPECT_LE(off[3], formula == DetectionFormula::paper ? 2e-7 : 3e-7);
    }
}

TEST(DetectionKernel, GaussianMeetsTheExactFormula) {
  Points<double> points(2003);
  const double h_width = deg_to_rad(65.0);
  const double v_width = deg_to_rad(40.0);
  const DetectionKernel kernel({AntennaPattern::gaussian(h_width, v_width), kR0});
  points.run(kernel);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const Exact x = points.x[i], y = points.y[i], z = points.z[i];
    const Exact h = std::atan2(y, x) / h_width;
    const Exact v = std::atan2(z, std::hypot(x, y)) / v_width;
    const Exact t = std::hypot(x, y, z) / kR0 * std::exp2(2.0L * (h * h + v * v)) * std::log(3.0L);
    const Exact exact = x > 0.0L ? 2.0L * std::exp(-t) / (1.0L + std::exp(-t)) : 0.0L;
    ASSERT_NEAR(points.p[i], static_cast<double>(exact), 1e-15);
    ASSERT_NEAR(kernel.probability({points.x[i], points.y[i], points.z[i]}), static_cast<double>(exact),
                1e-15);
  }
}

TEST(DetectionKernel, ATableIsLookedUpAndAnsweredTheSameWay) {
  const auto table = AntennaPattern::table({{-1.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}}, {{-1.0, 0.5}, {1.0, 0.5}});
  ASSERT_TRUE(table);
  const DetectionKernel kernel({*table, kR0});
  Points<double> points(101);
  points.run(kernel);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const hal::Vec3 p{points.x[i], points.y[i], points.z[i]};
    const double range = std::hypot(p.x, p.y, p.z);
    ASSERT_NEAR(points.p[i], detection_probability(normalised_range(range, kR0, table->power(p))), 1e-15);
  }
}

TEST(DetectionKernel, EachTagMayHaveItsOwnReach) {
  Points<double> points(77);
  std::vector<double> factor(points.x.size());
  hal::Random random(3);
  for (double& f : factor) f = random.uniform(0.5, 2.0);
  points.run(kernel_of(70.0, DetectionFormula::paper), factor);
  for (std::size_t i = 0; i < factor.size(); ++i)
    EXPECT_NEAR(points.p[i],
                static_cast<double>(exact_probability(points.x[i], points.y[i], points.z[i], deg_to_rad(70.0),
                                                      DetectionFormula::paper, kR0 * factor[i])),
                1e-15);
}

TEST(DetectionKernel, IsTheSameOnEveryVectorWidthAndAtEveryPlaceOfTheArray) {
  const DetectionKernel kernel = kernel_of(70.0, DetectionFormula::paper);
  Points<double> all(1021);
  all.run(kernel);
  const std::vector<double> best = all.p;
  for (const std::string& target : lane_targets()) {
    ASSERT_TRUE(use_lane_target(target)) << target;
    all.run(kernel);
    const bool fuses = testing::Value(target, testing::AnyOf(testing::HasSubstr("AVX"), "NEON"));
    for (std::size_t i = 0; i < best.size(); ++i)
      ASSERT_NEAR(all.p[i], best[i], fuses ? 0.0 : 1e-15) << target << ' ' << i;
  }
  ASSERT_TRUE(use_lane_target(""));
  EXPECT_FALSE(use_lane_target("abacus"));
  for (const std::size_t first : {1U, 3U, 500U, 1018U}) {
    std::vector<double> some(best.size() - first);
    const auto from = [first](const std::vector<double>& v) { return std::span(v).subspan(first); };
    kernel.probabilities(from(all.x), from(all.y), from(all.z), some);
    EXPECT_EQ(some, std::vector<double>(best.begin() + static_cast<std::ptrdiff_t>(first), best.end()));
  }
}

TEST(DetectionKernel, TheCutSilencesExactlyWhatLiesBelowIt) {
  Points<double> points(5000, 20.0);
  points.run(kernel_of(70.0, DetectionFormula::paper));
  const std::vector<double> whole = points.p;
  for (const double cut : {1e-12, 1e-9, 1e-6, 0.3}) {
    const DetectionKernel kernel = kernel_of(70.0, DetectionFormula::paper, cut);
    points.run(kernel);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      if (points.p[i] == whole[i]) continue;
      ASSERT_EQ(points.p[i], 0.0);
      ASSERT_LE(whole[i], cut * (1.0 + 1e-12));
    }
    EXPECT_NEAR(detection_probability(kernel.farthest_r0()), cut, 1e-12 * cut);
  }
}

TEST(DetectionKernel, WhateverGoesInAProbabilityComesOut) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const double values[] = {0.0,  -0.0, 5e-324, 1e-300, 1e-160, 1e-40, 1e-20, 1.0,
                           -1.0, 1e20, 1e160,  1e308,  kInf,   -kInf, kNaN};
  Points<double> points(0);
  Points<float> floats(0);
  for (const double x : values)
    for (const double y : values)
      for (const double z : values) {
        points.x.push_back(x), points.y.push_back(y), points.z.push_back(z);
        floats.x.push_back(static_cast<float>(x));
        floats.y.push_back(static_cast<float>(y));
        floats.z.push_back(static_cast<float>(z));
      }
  points.p.resize(points.x.size());
  floats.p.resize(points.x.size());
  for (const double width : {70.0, 90.0, 180.0, 0.0, 200.0, kNaN})
    for (const DetectionFormula formula : kFormulas) {
      const DetectionKernel kernel = kernel_of(width, formula);
      points.run(kernel);
      floats.run(kernel);
      for (std::size_t i = 0; i < points.p.size(); ++i) {
        const hal::Vec3 p{points.x[i], points.y[i], points.z[i]};
        const auto sane = [](double value) { return value >= 0.0 && value <= 1.0; };
        ASSERT_TRUE(sane(points.p[i]) && sane(static_cast<double>(floats.p[i])) &&
                    sane(kernel.probability(p)) && sane(kernel.reference(p)))
            << p.x << ' ' << p.y << ' ' << p.z << ", width " << width;
        // Nearer, and next to a null, where a point lies is a matter of rounding.
        if (!(std::hypot(p.x, p.y, p.z) < 1e-3)) {
          ASSERT_NEAR(points.p[i], kernel.reference(p), 1e-15) << p.x << ' ' << p.y << ' ' << p.z;
        }
      }
    }
}

TEST(DetectionKernel, TouchingTheAntennaIsBeingHeard) {
  const DetectionKernel kernel = kernel_of(70.0, DetectionFormula::paper);
  for (const double x : {5e-324, 1e-300, 1e-100, 1e-9}) {
    EXPECT_NEAR(kernel.probability({x, 0.0, 0.0}), 1.0, 1e-8) << x;
    std::vector<double> p(1);
    kernel.probabilities(std::vector{x}, std::vector{0.0}, std::vector{0.0}, p);
    EXPECT_NEAR(p[0], 1.0, 1e-8) << x;
  }
}

TEST(DetectionKernel, VariantsGoByName) {
  for (const DetectionFormula formula : kFormulas) {
    const auto found = detection_formula(to_string(formula));
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, formula);
  }
  const auto unknown = detection_formula("print");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(describe(unknown.error()), testing::HasSubstr("plugin as published"));
}

TEST(DetectionKernel, ACopyStandsOnItsOwn) {
  auto first = std::make_unique<DetectionKernel>(kernel_of(70.0, DetectionFormula::paper));
  const DetectionKernel copy = *first;
  first.reset();
  std::vector<double> p(1);
  copy.probabilities(std::vector{1e-300}, std::vector{0.0}, std::vector{0.0},
                     p);  // goes to the exact function
  EXPECT_EQ(p[0], 1.0);
}

}  // namespace
}  // namespace forager::mocks
