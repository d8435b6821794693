#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "boards/calibration_cells.hpp"
#include "boards/calibration_likelihood.hpp"
#include "boards/simplex_search.hpp"

namespace forager::boards::calibration {

// How calibrate() climbs its likelihood and walks down its profiles; not meant for other callers.

// 95 % of chi-square with one degree of freedom.
constexpr double kChiSquare95 = 3.841458820694124;
constexpr std::size_t kParameters = 3;
constexpr double kLowest[kParameters] = {-3.0, 0.0, -10.0};  // ln(R0/m), dB, dB
constexpr double kHighest[kParameters] = {3.5, 12.0, 30.0};
constexpr double kStep[kParameters] = {0.15, 0.7, 3.0};
constexpr const char* kNames[kParameters] = {"r0_m", "spread_db", "rician_k_db"};
constexpr const char* kUnits[kParameters] = {"m", "dB", "dB"};

using Point = std::array<double, kParameters>;

inline CalibrationParameters parameters_at(const Point& p) { return {std::exp(p[0]), p[1], p[2]}; }
inline Point point_of(const CalibrationParameters& p) {
  return {std::log(p.r0_m), p.spread_db, p.rician_k_db};
}

// Maximises over the parameters that are not held.
class Fitter {
 public:
  explicit Fitter(const CalibrationLikelihood& likelihood) : likelihood_(&likelihood) {}

  struct Best {
    Point at{};
    double log_likelihood = -std::numeric_limits<double>::infinity();
  };

  Best fit(const Point& from, const std::array<bool, kParameters>& held, int evaluations) {
    std::vector<std::size_t> free;
    std::vector<double> start;
    std::vector<double> step;
    for (std::size_t i = 0; i < kParameters; ++i) {
      if (held[i]) continue;
      free.push_back(i);
      start.push_back(from[i]);
      step.push_back(from[i] + steps_[i] > kHighest[i] ? -steps_[i] : steps_[i]);
    }
    Point at = from;
    const auto loss = [&](const std::vector<double>& x) {
      double outside = 0.0;
      for (std::size_t i = 0; i < free.size(); ++i) {
        at[free[i]] = std::clamp(x[i], kLowest[free[i]], kHighest[free[i]]);
        outside += std::abs(x[i] - at[free[i]]);
      }
      return -likelihood_->log_likelihood(parameters_at(at)) + 10.0 * outside;
    };
    const SimplexResult found = simplex_search(loss, start, step, {evaluations, 5e-3});
    evaluations_ += found.evaluations;
    Best best;
    best.log_likelihood = -loss(found.at);
    best.at = at;
    return best;
  }

  [[nodiscard]] double value(Point at) {
    for (std::size_t i = 0; i < kParameters; ++i) at[i] = std::clamp(at[i], kLowest[i], kHighest[i]);
    ++evaluations_;
    return likelihood_->log_likelihood(parameters_at(at));
  }
  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] std::vector<double> tag_values(Point at) {
    for (std::size_t i = 0; i < kParameters; ++i) at[i] = std::clamp(at[i], kLowest[i], kHighest[i]);
    ++evaluations_;
    return likelihood_->log_likelihoods(parameters_at(at));
  }
  // What the first simplex spans from now on.
  void set_steps(const Point& steps) { steps_ = steps; }

 private:
  const CalibrationLikelihood* likelihood_;
  Point steps_{kStep[0], kStep[1], kStep[2]};
  int evaluations_ = 0;
};

// How the likelihood bends about the best fit, each parameter in units of one standard deviation alone.
struct Bend {
  Point unit{};
  std::array<Point, kParameters> matrix{};
};

// Best of two starts, so that a shallow side valley does not catch it.
[[nodiscard]] Fitter::Best fit_all(Fitter& fitter, const CalibrationCells& cells,
                                   const std::array<bool, kParameters>& held, const Point& given);

// Fits once more in steps that suit the likelihood's width, and says how it bends there.
[[nodiscard]] Bend polish(Fitter& fitter, Fitter::Best& best, const std::array<bool, kParameters>& held);

// How many times wider than the likelihood says an estimate really scatters, as a variance: at least 1.
[[nodiscard]] Point excess_variance(Fitter& fitter, const Fitter::Best& best, const Bend& bend);

// What the profile likelihood loses, twice, where one parameter is held at a value.
[[nodiscard]] double profile_loss(Fitter& fitter, const Fitter::Best& best, const Bend& bend,
                                  std::array<bool, kParameters> held, std::size_t which, double value);

// Where the profile has lost enough on one side; `open` if it has not at the edge of what is looked at.
[[nodiscard]] double interval_end(Fitter& fitter, const Fitter::Best& best, const Bend& bend,
                                  const std::array<bool, kParameters>& held, std::size_t which,
                                  double direction, double excess, bool& open);

}  // namespace forager::boards::calibration
