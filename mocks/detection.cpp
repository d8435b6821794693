#include "mocks/detection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace forager::mocks {
namespace {

constexpr double kLn3 = 1.0986122886681098;
// log2(3) as the nearest double and what is missing there.
constexpr double kLog2Of3 = 1.584962500721156;
constexpr double kLog2Of3Rest = 1.0579781240112554e-16;
// Twice 2^-t is below half the smallest number from here on.
constexpr double kNothingLeft = 1080.0;

// 2 / (1 + 3^(u + rest)) for rest far below u.
double compensated(double u, double rest) {
  const double t = u * kLog2Of3;
  if (!(t < kNothingLeft)) return 0.0;
  const double t_rest = std::fma(u, kLog2Of3, -t) + (u * kLog2Of3Rest + rest * kLog2Of3);
  // tail + tail_rest = 2^-(t + t_rest), sum + sum_rest = 1 + tail + tail_rest: only exp2 and the last line
  // round.
  const double tail = std::exp2(-t);
  const double tail_rest = -tail * (t_rest * std::numbers::ln2);
  const double sum = 1.0 + tail;
  const double sum_rest = (tail - (sum - 1.0)) + tail_rest;
  const double quotient = 2.0 * tail / sum;
  const double remainder = std::fma(-quotient, sum, 2.0 * tail) + (2.0 * tail_rest - quotient * sum_rest);
  return std::min(quotient + remainder / sum, 1.0);
}

}  // namespace

double normalised_range(double range_m, double r0_m, double pattern_power, double pattern_exponent) {
  constexpr double kOutOfReach = std::numeric_limits<double>::infinity();
  if (!(r0_m > 0.0) || !(pattern_power > 0.0) || !(range_m >= 0.0)) return kOutOfReach;
  const double shape = pattern_exponent == kPaperPatternExponent ? std::sqrt(pattern_power)
                       : pattern_exponent == kPluginPatternExponent
                           ? pattern_power
                           : std::pow(pattern_power, pattern_exponent);
  const double u = range_m / (r0_m * shape);
  return u >= 0.0 ? u : kOutOfReach;
}

double detection_probability(double u) {
  if (!(u >= 0.0)) return 0.0;
  const double tail = std::exp(-u * kLn3);
  return 2.0 * tail / (1.0 + tail);
}

double detection_probability_compensated_u(double u) {
  if (!(u >= 0.0)) return 0.0;
  return compensated(u, 0.0);
}

double detection_probability_compensated(double u_squared) {
  if (!(u_squared >= 0.0)) return 0.0;
  const double u = std::sqrt(u_squared);
  if (!(u > 0.0 && u <= kNothingLeft)) return compensated(u, 0.0);
  return compensated(u, std::fma(-u, u, u_squared) / (2.0 * u));
}

double expected_answers(double u) {
  if (!(u >= 0.0)) return 0.0;
  const double t = u * kLn3;
  const double tail = std::exp(-t);
  // tanh(t/2) = (1 - tail) / (1 + tail); 1 - tail cancels for small t, log(1 - tail) for large t.
  const double log_numerator = t < std::numbers::ln2 ? std::log(-std::expm1(-t)) : std::log1p(-tail);
  return std::log1p(tail) - log_numerator;
}

double answer_probability(double hazard_per_s, double dwell_s) {
  if (!(hazard_per_s > 0.0) || !(dwell_s > 0.0)) return 0.0;
  return -std::expm1(-hazard_per_s * dwell_s);
}

}  // namespace forager::mocks
