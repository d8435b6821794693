#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hal/pose.hpp"
#include "mocks/antenna_pattern.hpp"

namespace forager::mocks {

// An upper bound of a beam's power without trigonometry: both cuts fall with the angle off their middle, so
// a table over its cosine holds the power at the near edge of each step. Loose by a few percent near the
// middle; measured cuts have the bound 1.
class BeamBound {
 public:
  explicit BeamBound(const AntennaPattern& pattern);

  // Not below pattern.power(p), for coordinates below 1e150. range_m: |p|.
  [[nodiscard]] double bound(hal::Vec3 p, double range_m) const {
    if (!any_) return 1.0;
    if (!(p.x > 0.0)) return 0.0;
    const double plan = std::sqrt(p.x * p.x + p.y * p.y);
    return azimuth_[step(p.x / plan)] * elevation_[step(plan / range_m)];
  }

 private:
  static constexpr std::size_t kSteps = 128;
  static std::size_t step(double cosine) {
    // In this order NaN, of places next to nothing, becomes the last step.
    return static_cast<std::size_t>(
        std::min(static_cast<double>(kSteps) - 1.0, cosine * static_cast<double>(kSteps)));
  }
  bool any_ = false;
  std::array<double, kSteps> azimuth_{};
  std::array<double, kSteps> elevation_{};
};

}  // namespace forager::mocks
