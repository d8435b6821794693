#pragma once

#include <cmath>

// Unevaluated sums of two doubles, about 106 bits: what a difference of products needs so that it does not
// cancel, and what an angle near a whole turn needs to be told from it. (Dekker 1971; Muller et al., Handbook
// of Floating-Point Arithmetic, 2018, ch. 4.) Exact as long as nothing overflows or underflows.
namespace forager::servo {

struct DoublePair {
  double high = 0.0;  // the sum, rounded
  double low = 0.0;   // what the rounding left over
};

// a + b, exactly.
[[nodiscard]] inline DoublePair exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_in_sum = sum - a;
  return {sum, (a - (sum - b_in_sum)) + (b - b_in_sum)};
}

// a * b, exactly.
[[nodiscard]] inline DoublePair exact_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

// The functions below round: relative error a few 2^-104, of the larger operand where signs differ.
[[nodiscard]] inline DoublePair operator+(DoublePair a, double b) {
  const DoublePair sum = exact_sum(a.high, b);
  return exact_sum(sum.high, sum.low + a.low);
}
[[nodiscard]] inline DoublePair operator-(DoublePair a) { return {-a.high, -a.low}; }
[[nodiscard]] inline DoublePair operator/(DoublePair a, DoublePair b) {
  const double quotient = a.high / b.high;
  const double remainder = std::fma(-quotient, b.high, a.high);
  return exact_sum(quotient, (remainder + (a.low - quotient * b.low)) / b.high);
}
// 0 for 0; a.high >= 0.
[[nodiscard]] inline DoublePair root(DoublePair a) {
  if (a.high <= 0.0) return {};
  const double r = std::sqrt(a.high);
  return exact_sum(r, (std::fma(-r, r, a.high) + a.low) / (2.0 * r));
}

}  // namespace forager::servo
