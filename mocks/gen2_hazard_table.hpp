#pragma once

#include <cstddef>
#include <vector>

#include "mocks/gen2_field_parameters.hpp"

namespace forager::mocks {

// A tag nearer than this share of its R0 is heard as often as there: 4.5 answers in T0. The logarithm has no
// limit of its own, and the draw needs one.
inline constexpr double kNearestU = 0.02;

// Upper bounds of the hazard rate by normalised range u, one look-up each: the rate at the lower end of a
// step of 1/128, at most 10 % above the rate at u (1 % beyond u = 0.2).
class HazardTable {
 public:
  explicit HazardTable(const AirParameters& air);

  // No link of normalised range u or more has a higher rate, 1/s. 0 beyond last_u() and for NaN.
  [[nodiscard]] double bound(double u) const {
    if (!(u <= last_u_)) return 0.0;
    const double step = u * kStepsPerU;
    return step < static_cast<double>(rates_.size()) ? rates_[static_cast<std::size_t>(step)] : tail_;
  }
  // Beyond it nothing answers (power-up limit), or so seldom that it is not drawn (hazard cut); may be
  // infinite.
  [[nodiscard]] double last_u() const { return last_u_; }

 private:
  static constexpr double kStepsPerU = 128.0;
  static constexpr double kLongest = 8.0;  // R0; from there on one bound for all, 3e-4 / T0
  double last_u_;
  double tail_;
  std::vector<double> rates_;
};

}  // namespace forager::mocks
