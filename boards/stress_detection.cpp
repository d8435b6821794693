#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "boards/detection_truth.hpp"
#include "boards/stress_case.hpp"
#include "hal/random.hpp"
#include "mocks/detection.hpp"
#include "mocks/detection_kernel.hpp"

namespace forager::boards {
namespace {

using mocks::AntennaPattern;
using mocks::DetectionFormula;
using mocks::DetectionKernel;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kR0_m = 2.4;
const double kWidth = hal::deg_to_rad(70.0);

DetectionKernel kernel_of(double width_rad, DetectionFormula formula = DetectionFormula::paper) {
  return DetectionKernel({AntennaPattern::cosine_squared(width_rad, width_rad), kR0_m, formula});
}

// One point through all ways, floats included.
struct Answers {
  double reference, scalar, vector, vector_f32;
};
Answers ask(const DetectionKernel& kernel, hal::Vec3 p) {
  double vector = kNaN;
  float vector_f32 = 0.0F;
  const auto one = [](const auto& value) { return std::span(&value, 1); };
  kernel.probabilities(one(p.x), one(p.y), one(p.z), std::span(&vector, 1));
  const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y), z = static_cast<float>(p.z);
  kernel.probabilities(one(x), one(y), one(z), std::span(&vector_f32, 1));
  return {kernel.reference(p), kernel.probability(p), vector, static_cast<double>(vector_f32)};
}

StressCase curve_in_ulp() {
  Worst worst;
  hal::Random random(1);
  for (int i = 0; i < 16384; ++i) {
    const double x = std::pow(10.0, random.uniform(-8.0, 4.0));
    const Wide exact = exact_curve(x);
    const double ulp = std::nextafter(exact.high, 2.0) - exact.high;
    const double off = (mocks::detection_probability_compensated(x) - exact.high) - exact.low;
    worst.add(std::abs(off) / ulp);
  }
  return worst.against("detection: compensated curve, x of 1e-8 to 1e4, ulp", 2.2);
}

StressCase curve_by_vectors(bool f32) {
  Worst worst;
  hal::Random random(2);
  std::vector<float> x_f32(16384), p_f32(x_f32.size());
  for (float& x : x_f32) x = static_cast<float>(std::pow(10.0, random.uniform(-8.0, 4.0)));
  const std::vector<double> x(x_f32.begin(), x_f32.end());
  std::vector<double> p(x.size());
  mocks::detection_curve_lanes(x_f32.data(), x.size(), p_f32.data());
  mocks::detection_curve_lanes(x.data(), x.size(), p.data());
  for (std::size_t i = 0; i < x.size(); ++i)
    worst.near(f32 ? static_cast<double>(p_f32[i]) : p[i], exact_curve(x[i]).rounded());
  return f32 ? worst.against("detection: curve by vectors, f32, absolute", 1.5e-7)
             : worst.against("detection: curve by vectors, f64, absolute", 3.4e-16);
}

StressCase curve_ends() {
  Worst worst;
  for (const double u : {0.0, -0.0, 5e-324, 1e-300, 1e4, 1e300, -1.0, kInf, -kInf, kNaN}) {
    const double dead = !(u >= 0.0) || u >= 1e4 ? 0.0 : 1.0;
    float p_f32 = 0.0F;
    double p = 0.0;
    const double square = u < 0.0 ? u : u * u;  // -0 stays what it is
    const auto square_f32 = static_cast<float>(square);
    mocks::detection_curve_lanes(&square, 1, &p);
    mocks::detection_curve_lanes(&square_f32, 1, &p_f32);
    for (const double answer :
         {mocks::detection_probability(u), mocks::detection_probability_compensated_u(u),
          mocks::detection_probability_compensated(square), p, static_cast<double>(p_f32)})
      worst.must(answer == dead);
    worst.must(mocks::expected_answers(u) >= 0.0);
  }
  return worst.against("detection: u of 0, -0, 5e-324, 1e4, 1e300, infinity, NaN, below 0", 0.0);
}

// Between a last normal number and nothing: no way may come out above it, or negative.
StressCase curve_denormal() {
  Worst worst;
  for (const double u : evenly(640.0, 690.0, 0.01)) {
    const Wide exact = u * 1.585 < 990.0 ? exact_curve(u * u) : Wide(0.0);
    for (const double p : {mocks::detection_probability(u), mocks::detection_probability_compensated_u(u)})
      worst.add(p >= 0.0 ? std::abs(p - exact.rounded()) : kNaN);
  }
  return worst.against("detection: tails down to the denormals, absolute", 1e-290);
}

StressCase places_without_direction() {
  Worst worst;
  const double lengths[] = {0.0, -0.0, 5e-324, 1e-300, 1e-160, 1e-20, 1.0, 1e160, 1e300, kInf, kNaN, -1.0};
  for (const DetectionFormula formula :
       {DetectionFormula::paper, DetectionFormula::plugin, DetectionFormula::plugin_as_published})
    for (const double width : {kWidth, hal::kPi / 2.0, hal::kPi, 0.0, kNaN}) {
      const DetectionKernel kernel = kernel_of(width, formula);
      for (const double x : lengths)
        for (const double y : lengths)
          for (const double z : lengths) {
            const Answers a = ask(kernel, {x, y, z});
            for (const double p : {a.reference, a.scalar, a.vector, a.vector_f32})
              worst.must(p >= 0.0 && p <= 1.0 && (x > 0.0 || p == 0.0));
          }
    }
  return worst.against("detection: origin, axes, denormals, 1e300, infinities, NaN: within 0..1", 0.0);
}

StressCase boresight() {
  Worst worst;
  for (const double width : {kWidth, hal::kPi / 2.0, hal::kPi}) {
    const DetectionKernel kernel = kernel_of(width);
    for (const double range : geometrically(1e-9, 1e9, 1.7)) {
      const double exact = exact_detection({range, 0.0, 0.0}, {width, width, kR0_m});
      const Answers a = ask(kernel, {range, 0.0, 0.0});
      for (const double p : {a.reference, a.scalar, a.vector}) worst.near(p, exact);
    }
  }
  return worst.against("detection: on boresight, 1e-9 to 1e9 m, absolute", 1e-15);
}

StressCase nulls() {
  Worst worst;
  for (const double width : {0.2, kWidth, 1.5}) {
    const DetectionKernel kernel = kernel_of(width);
    const auto check = [&](double azimuth, double elevation) {
      const double planar = 2.0 * std::cos(elevation);
      const hal::Vec3 p{planar * std::cos(azimuth), planar * std::sin(azimuth), 2.0 * std::sin(elevation)};
      const Answers a = ask(kernel, p);
      for (const double answer : {a.reference, a.scalar, a.vector, a.vector_f32}) worst.near(answer, 0.0);
    };
    double above = width;
    double below = width;
    for (int i = 0; i < 64; ++i) {
      for (const double angle : {above, below, -above, -below}) {
        check(angle, 0.0);
        check(0.0, angle);
      }
      above = std::nextafter(above, 2.0);
      below = std::nextafter(below, 0.0);
    }
  }
  return worst.against("detection: at the null of the pattern and 64 ulp to both sides", 0.0);
}

StressCase beyond_the_null() {
  Worst worst;
  const DetectionKernel kernel = kernel_of(kWidth);
  for (const double angle : evenly(70.001, 180.0, 0.25))
    for (const double side : {-1.0, 1.0}) {
      const double a = side * hal::deg_to_rad(angle);
      for (const hal::Vec3 p :
           {hal::Vec3{std::cos(a), std::sin(a), 0.0}, hal::Vec3{std::cos(a), 0.0, std::sin(a)}}) {
        const Answers answers = ask(kernel, 0.1 * p);
        for (const double answer : {answers.reference, answers.scalar, answers.vector, answers.vector_f32})
          worst.near(answer, 0.0);
      }
    }
  return worst.against("detection: beyond the null and behind, where the bare cos^2 rises again", 0.0);
}

StressCase any_width_of_vectors() {
  Worst worst;
  const DetectionKernel kernel = kernel_of(kWidth);
  hal::Random random(5);
  std::vector<double> x(1003), y(x.size()), z(x.size()), best(x.size()), other(x.size());
  for (auto* axis : {&x, &y, &z})
    for (double& value : *axis) value = random.uniform(-8.0, 8.0);
  kernel.probabilities(x, y, z, best);
  for (const std::string& target : mocks::lane_targets()) {
    worst.must(mocks::use_lane_target(target));
    kernel.probabilities(x, y, z, other);
    for (std::size_t i = 0; i < best.size(); ++i) worst.near(other[i], best[i]);
  }
  worst.must(mocks::use_lane_target(""));
  return worst.against("detection: the same on every vector width of this machine", 1e-15);
}

StressCase both_ends_of_the_logarithm() {
  Worst worst;
  for (const double u : geometrically(1e-6, 600.0, 1.1)) {
    const double again = mocks::answer_probability(mocks::expected_answers(u), 1.0);
    worst.relative(again,
                   exact_curve(u * u).rounded() > 0.0 ? mocks::detection_probability_compensated_u(u) : 0.0);
  }
  return worst.against("hazard: 1 - exp(ln(1 - PD)) is PD, u of 1e-6 to 600, relative", 3e-13);
}

// 1 - (1 - 1e-12)^1000 as a product loses five digits.
StressCase rare_and_often() {
  Worst worst;
  for (const double p : {1e-15, 1e-12, 1e-9, 1e-3}) {
    const double hazard = -std::log1p(-p);
    for (const double n : {10.0, 1000.0, 1e6}) {
      const long double exact =
          -std::expm1(static_cast<long double>(n) * std::log1p(-static_cast<long double>(p)));
      worst.relative(mocks::answer_probability(hazard, n), static_cast<double>(exact));
    }
  }
  return worst.against("hazard: 1 - (1 - p)^n, p from 1e-15, n to 1e6, relative", 1e-14);
}

}  // namespace

std::vector<StressCase> stress_detection() {
  return {curve_in_ulp(),
          curve_by_vectors(false),
          curve_by_vectors(true),
          curve_ends(),
          curve_denormal(),
          places_without_direction(),
          boresight(),
          nulls(),
          beyond_the_null(),
          any_width_of_vectors(),
          both_ends_of_the_logarithm(),
          rare_and_often()};
}

}  // namespace forager::boards
