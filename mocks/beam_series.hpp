#pragma once

#include <array>
#include <span>

namespace forager::mocks {

// A function of the angle off boresight, as a polynomial in w = tan^2(angle / 2): no arc tangent, no cosine.
// w of an azimuth is (y / (x + hypot(x, y)))^2, free of cancellation, and every even function of the angle is
// analytic in it up to 180 degrees, so few terms do: 17 for the cosine pattern of a 70 degree antenna in
// double.
struct BeamSeries {
  static constexpr std::size_t kMost = 40;
  std::array<double, kMost> coefficient{};  // of 1, w, w^2, ...
  std::size_t terms = 1;
  double end = 1.0;    // the series holds for 0 <= w <= end
  double error = 0.0;  // bound of |series - function| over that range, without rounding

  [[nodiscard]] double operator()(double w) const {
    double sum = coefficient[terms - 1];
    for (std::size_t i = terms - 1; i-- > 0;) sum = sum * w + coefficient[i];
    return sum;
  }
};

// cos(pi/2 angle / width), 0 < width <= pi, for angles to the null at `width` or 90 degrees; where
// `without_null`, divided by 1 - w / null_of_beam(width): without its zero the function hardly changes, and
// near the null no digits are lost but those of w. Truncated where what is left out sums to less than
// `tolerance`.
[[nodiscard]] BeamSeries cosine_beam_series(double width_rad, bool without_null, double tolerance);
// w = tan^2(width / 2) of that null, as a sum of two doubles. width < pi.
struct BeamNull {
  double w;
  double rest;
};
[[nodiscard]] BeamNull null_of_beam(double width_rad);

// 2 (angle / width)^2 for angles to 90 degrees: -log2 of the square root of the Gaussian pattern.
[[nodiscard]] BeamSeries gaussian_beam_series(double width_rad, double tolerance);

}  // namespace forager::mocks
