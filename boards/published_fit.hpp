#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "boards/calibration.hpp"
#include "boards/reproduce.hpp"

namespace forager::boards {

struct PublishedFitOptions {
  std::string folder = "scenes";
  std::uint64_t seeds = 3;  // missions of each experiment, the same seeds for every parameter set
  int evaluations = 60;     // parameter sets tried at most
  std::optional<CalibrationParameters> start;  // instead of what the scenes say
  std::vector<std::string> runs;               // empty: the fourteen of chapter 3
  std::function<void(int, double)> progress;   // set tried, its root mean square in points
};

struct PublishedFit {
  std::vector<FittedParameter> parameters;
  Reproduction reproduction;      // with the parameters found
  CalibrationParameters started;  // from there
  double started_rms_points = 0.0;
  int evaluations = 0;
};

// Fits R0, spread and K to the published totals: the least sum of squared differences of coverage over common
// random numbers. From a start that is given it takes damped Gauss-Newton steps first, then, as from what the
// scenes say, searches without derivatives until the figures no longer get better. Intervals are those of a
// linear model about the optimum: the derivatives of all figures by differences, the residuals' own variance,
// Student's t. Durations take no part.
//
// Errors: those of reproduce; refused if the figures do not depend on a parameter (their derivatives make a
// singular matrix) or there are no more figures than parameters, naming it.
[[nodiscard]] hal::Result<PublishedFit> fit_published(const PublishedFitOptions& options);

}  // namespace forager::boards
