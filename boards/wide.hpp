#pragma once

#include <array>
#include <cmath>

// Arithmetic to about 100 bits, as sums of two doubles (Dekker 1971; Knuth), for references against which the
// geometry is measured: portable where long double is 53 bits and a 128 bit type does not exist. Shares no
// line with what it judges; its own tests hold it to printed constants. Magnitudes 1e-140 .. 1e140.
namespace forager::boards {

struct Wide {
  double high = 0.0;
  double low = 0.0;

  constexpr Wide() = default;
  constexpr Wide(double value) : high(value) {}  // NOLINT(google-explicit-constructor): a number is a number
  constexpr Wide(double h, double l) : high(h), low(l) {}
  [[nodiscard]] constexpr double rounded() const { return high + low; }
};

inline constexpr Wide kWidePi{3.141592653589793116, 1.2246467991473532e-16};

[[nodiscard]] constexpr Wide two_sum(double a, double b) {
  const double s = a + b;
  const double v = s - a;
  return {s, (a - (s - v)) + (b - v)};
}
[[nodiscard]] constexpr Wide operator-(Wide a) { return {-a.high, -a.low}; }
[[nodiscard]] constexpr Wide operator+(Wide a, Wide b) {
  const Wide s = two_sum(a.high, b.high);
  const Wide t = two_sum(a.low, b.low);
  const Wide u = two_sum(s.high, s.low + t.high);
  return two_sum(u.high, u.low + t.low);
}
[[nodiscard]] constexpr Wide operator-(Wide a, Wide b) { return a + -b; }
[[nodiscard]] inline Wide operator*(Wide a, Wide b) {
  const double p = a.high * b.high;
  return two_sum(p, std::fma(a.high, b.high, -p) + (a.high * b.low + a.low * b.high));
}
[[nodiscard]] inline Wide operator/(Wide a, Wide b) {
  const double first = a.high / b.high;
  const Wide rest = a - b * Wide(first);
  const double second = rest.high / b.high;
  return two_sum(first, second) + Wide((rest - b * Wide(second)).high / b.high);
}
[[nodiscard]] constexpr bool operator<(Wide a, Wide b) {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}

// 0 for what is not positive.
[[nodiscard]] inline Wide sqrt(Wide a) {
  if (!(a.high > 0.0)) return {};
  const double root = std::sqrt(a.high);
  return two_sum(root, (a - Wide(root) * Wide(root)).high / (2.0 * root));
}
[[nodiscard]] inline Wide hypot(Wide x, Wide y) { return sqrt(x * x + y * y); }

struct WideDirection {
  Wide cos;
  Wide sin;
};

// Product of two rotations.
[[nodiscard]] inline WideDirection operator*(const WideDirection& a, const WideDirection& b) {
  return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
}

// cos and sin of k pi / 16, k = 0 .. 31.
[[nodiscard]] inline const std::array<WideDirection, 32>& sixteenths_of_pi() {
  static const std::array<WideDirection, 32> table = [] {
    const Wide eighth = sqrt(Wide(2.0) + sqrt(Wide(2.0)));
    const WideDirection step{sqrt(Wide(2.0) + eighth) * Wide(0.5), sqrt(Wide(2.0) - eighth) * Wide(0.5)};
    std::array<WideDirection, 32> out{};
    out[0] = {Wide(1.0), Wide(0.0)};
    for (std::size_t k = 1; k < out.size(); ++k) out[k] = out[k - 1] * step;
    return out;
  }();
  return table;
}

// 1 / n!
[[nodiscard]] inline const std::array<Wide, 20>& inverse_factorials() {
  static const std::array<Wide, 20> table = [] {
    std::array<Wide, 20> out{};
    out[0] = Wide(1.0);
    for (std::size_t n = 1; n < out.size(); ++n) out[n] = out[n - 1] / Wide(static_cast<double>(n));
    return out;
  }();
  return table;
}

// Absolute error below 1e-30 for |angle| < 100.
[[nodiscard]] inline WideDirection direction(Wide angle) {
  const double k = std::nearbyint(angle.high * (16.0 / kWidePi.high));
  const Wide x = angle - kWidePi * Wide(k / 16.0);
  const Wide minus_square = -(x * x);
  // Taylor, |x| <= pi / 32: the first term left out is below 1e-34.
  const auto& inverse = inverse_factorials();
  Wide cosine = inverse[18];
  Wide sine = inverse[19];
  for (std::size_t pair = 9; pair-- > 0;) {
    cosine = cosine * minus_square + inverse[2 * pair];
    sine = sine * minus_square + inverse[2 * pair + 1];
  }
  const auto index = static_cast<std::size_t>(static_cast<long>(k) & 31L);
  return sixteenths_of_pi()[index] * WideDirection{cosine, sine * x};
}

// Angle of (x, y) in about [-pi, pi]: one Newton step from the double.
[[nodiscard]] inline Wide atan2(Wide y, Wide x) {
  const Wide guess(std::atan2(y.high, x.high));
  const WideDirection d = direction(guess);
  return guess + (y * d.cos - x * d.sin) / (x * d.cos + y * d.sin);
}

}  // namespace forager::boards
