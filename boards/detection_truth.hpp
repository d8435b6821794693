#pragma once

#include "boards/wide.hpp"
#include "hal/pose.hpp"
#include "mocks/detection_lanes.hpp"

namespace forager::boards {

// 2^t to about 100 bits for -1000 < t < 1000.
[[nodiscard]] Wide exp2(Wide t);

// 2 / (1 + 3^sqrt(x)) to about 100 bits, for 0 <= x <= 1e5.
[[nodiscard]] Wide exact_curve(double x);

struct BeamTruth {
  double width_h_rad = 0.0;
  double width_v_rad = 0.0;
  double r0_m = 1.0;
  mocks::DetectionFormula formula = mocks::DetectionFormula::paper;
};

// Equations 4.1 and 4.3 of the thesis, with true nulls, or their forms in the published plugin: u of a tag in
// the antenna frame, in extended precision, and its PD rounded to double. Shares nothing with what it judges.
// u is infinite, and PD 0, where the pattern is 0. Coordinates of 1e-100 to 1e100 m, or 0.
[[nodiscard]] Wide exact_normalised_range(hal::Vec3 point, const BeamTruth& beam);
[[nodiscard]] double exact_detection(hal::Vec3 point, const BeamTruth& beam);

}  // namespace forager::boards
