#include "mocks/beam_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace forager::mocks {
namespace {

using Wide = long double;
constexpr Wide kPi = std::numbers::pi_v<Wide>;
constexpr std::size_t kNodes = 64;

// cos(k pi / (2 kNodes)), k = 0 .. 4 kNodes - 1: all that a Chebyshev transform needs.
const std::array<Wide, 4 * kNodes>& cosines() {
  static const std::array<Wide, 4 * kNodes> table = [] {
    std::array<Wide, 4 * kNodes> t{};
    for (std::size_t k = 0; k < t.size(); ++k) t[k] = std::cos(kPi * static_cast<Wide>(k) / (2 * kNodes));
    return t;
  }();
  return table;
}

// Chebyshev coefficients of function(w) over 0 <= w <= end, by its values at the Chebyshev points.
template <class Function>
std::vector<Wide> chebyshev(Wide end, const Function& function) {
  std::vector<Wide> values(kNodes);
  for (std::size_t i = 0; i < kNodes; ++i) values[i] = function((cosines()[2 * i + 1] + 1.0L) * end / 2.0L);
  std::vector<Wide> c(BeamSeries::kMost);
  for (std::size_t j = 0; j < c.size(); ++j) {
    for (std::size_t i = 0; i < kNodes; ++i) c[j] += values[i] * cosines()[j * (2 * i + 1) % (4 * kNodes)];
    c[j] *= (j == 0 ? 1.0L : 2.0L) / kNodes;
  }
  return c;
}

// Powers of w instead of Chebyshev polynomials in s = 2 w/end - 1: T0 = 1, T1 = s, T(j+1) = 2 s Tj - T(j-1).
// The coefficients c fall at least as fast as those of the polynomials grow, so hardly a digit is lost.
BeamSeries in_powers(const std::vector<Wide>& c, Wide end, double tolerance) {
  BeamSeries series;
  series.end = static_cast<double>(end);
  series.terms = c.size();
  Wide left_out = 0.0L;
  while (series.terms > 1 && left_out + std::abs(c[series.terms - 1]) < static_cast<Wide>(tolerance))
    left_out += std::abs(c[--series.terms]);
  series.error = static_cast<double>(left_out);
  std::array<Wide, BeamSeries::kMost> sum{};
  std::array<Wide, BeamSeries::kMost> before{};
  std::array<Wide, BeamSeries::kMost> now{};
  now[0] = 1.0L;
  for (std::size_t j = 0; j < series.terms; ++j) {
    for (std::size_t i = 0; i <= j; ++i) sum[i] += c[j] * now[i];
    std::array<Wide, BeamSeries::kMost> next{};
    const Wide twice = j == 0 ? 1.0L : 2.0L;
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = twice * ((i > 0 ? now[i - 1] * (2.0L / end) : 0.0L) - now[i]) - (j > 0 ? before[i] : 0.0L);
    before = now;
    now = next;
  }
  std::transform(sum.begin(), sum.end(), series.coefficient.begin(),
                 [](Wide value) { return static_cast<double>(value); });
  return series;
}

Wide squared(Wide x) { return x * x; }
Wide angle_of(Wide w) { return 2.0L * std::atan(std::sqrt(w)); }

}  // namespace

BeamSeries cosine_beam_series(double width_rad, bool without_null, double tolerance) {
  const Wide width = width_rad;
  const Wide zero = std::tan(width / 2.0L);
  const Wide end = squared(std::tan(std::min(width, kPi / 2.0L) / 2.0L));
  const auto cosine = [=](Wide w) { return std::cos(kPi / 2.0L * angle_of(w) / width); };
  // The distance to the null, zero - sqrt(w), is in both parts of the ratio, so its rounding cancels.
  const auto ratio = [=](Wide w) {
    const Wide q = std::sqrt(w);
    const Wide angle_to_null = 2.0L * std::atan((zero - q) / (1.0L + zero * q));
    return std::sin(kPi / 2.0L * angle_to_null / width) / ((zero - q) / zero * ((zero + q) / zero));
  };
  return without_null ? in_powers(chebyshev(end, ratio), end, tolerance)
                      : in_powers(chebyshev(end, cosine), end, tolerance);
}

BeamNull null_of_beam(double width_rad) {
  const Wide w = squared(std::tan(static_cast<Wide>(width_rad) / 2.0L));
  const auto rounded = static_cast<double>(w);
  return {rounded, static_cast<double>(w - rounded)};
}

BeamSeries gaussian_beam_series(double width_rad, double tolerance) {
  const Wide width = width_rad;
  return in_powers(chebyshev(1.0L, [=](Wide w) { return 2.0L * squared(angle_of(w) / width); }), 1.0L,
                   tolerance);
}

}  // namespace forager::mocks
