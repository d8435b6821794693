#include "boards/detection_truth.hpp"

#include <cmath>
#include <limits>

namespace forager::boards {
namespace {

constexpr Wide kLog2Of3{1.584962500721156, 1.0579781240112554e-16};
constexpr Wide kLn2{0.6931471805599453, 2.3190468138462996e-17};
constexpr double kInf = std::numeric_limits<double>::infinity();

Wide absolute(Wide a) { return a.high < 0.0 ? -a : a; }

Wide curve_of_exponent(Wide t) {
  if (!(t.high < 1000.0)) return {};
  const Wide tail = exp2(-t);
  return (tail + tail) / (Wide(1.0) + tail);
}

// cos(pi/2 angle / width), 0 from the null on.
Wide cut(Wide angle, double width_rad) {
  const Wide magnitude = absolute(angle);
  if (!(magnitude < Wide(width_rad))) return {};
  return direction(kWidePi * Wide(0.5) * magnitude / Wide(width_rad)).cos;
}

}  // namespace

Wide exp2(Wide t) {
  const double whole = std::nearbyint(t.high);
  // 2^(1/64) and six squarings: the series of |r| <= ln 2 / 128 needs 14 terms.
  const Wide r = (t - Wide(whole)) * kLn2 * Wide(1.0 / 64.0);
  Wide sum(1.0);
  for (int n = 14; n > 0; --n) sum = Wide(1.0) + r * sum / Wide(n);
  for (int i = 0; i < 6; ++i) sum = sum * sum;
  return {std::ldexp(sum.high, static_cast<int>(whole)), std::ldexp(sum.low, static_cast<int>(whole))};
}

Wide exact_curve(double x) { return curve_of_exponent(sqrt(Wide(x)) * kLog2Of3); }

Wide exact_normalised_range(hal::Vec3 point, const BeamTruth& beam) {
  if (!(point.x > 0.0)) return kInf;
  const bool published = beam.formula == mocks::DetectionFormula::plugin_as_published;
  const Wide x(point.x), y(point.y), z(point.z);
  const Wide planar = hypot(x, y);
  const Wide amplitude =
      cut(atan2(y, x), beam.width_h_rad) * cut(atan2(z, published ? x : planar), beam.width_v_rad);
  if (!(amplitude.high > 0.0)) return kInf;
  const Wide shape = beam.formula == mocks::DetectionFormula::paper ? amplitude : amplitude * amplitude;
  return (published ? planar : hypot(planar, z)) / (Wide(beam.r0_m) * shape);
}

double exact_detection(hal::Vec3 point, const BeamTruth& beam) {
  const Wide u = exact_normalised_range(point, beam);
  return u.high < 1e4 ? curve_of_exponent(u * kLog2Of3).rounded() : 0.0;
}

}  // namespace forager::boards
