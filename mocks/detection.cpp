#include "mocks/detection.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace forager::mocks {
namespace {

constexpr double kLn3 = 1.0986122886681098;

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
