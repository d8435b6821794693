#pragma once

#include <vector>

#include "boards/calibration_cells.hpp"

namespace forager::boards {

// What is fitted. R0 as in mocks/detection.hpp for the scene's T0; spread the standard deviation of the tags'
// sensitivity; K the Rician factor of the frozen fade.
struct CalibrationParameters {
  double r0_m = 2.5;
  double spread_db = 2.0;
  double rician_k_db = 8.0;
};

// How likely the cells are. A tag answers at the hazard -ln(1 - PD(u))/T0 while its port listens and u is
// below the power-up limit; the tag's sensitivity (normal, one number a tag) and the fade (Rician, one number
// a cell) are integrated out by quadrature. Cells of one tag are independent given its
// sensitivity.
class CalibrationLikelihood {
 public:
  CalibrationLikelihood(const CalibrationCells& cells, double t0_s, double power_up_limit);

  [[nodiscard]] double log_likelihood(const CalibrationParameters& p) const;
  // Tag by tag.
  [[nodiscard]] std::vector<double> log_likelihoods(const CalibrationParameters& p) const;
  // Expected number of slices in which bin i is seen, over all bins: for residuals.
  [[nodiscard]] std::vector<double> expected_seen(const CalibrationParameters& p) const;

 private:
  [[nodiscard]] double rate(double u_db) const;

  // Log-likelihood of a cell whose tag and fade together reach by so many dB more than 1 m.
  [[nodiscard]] double cell_log(std::size_t cell, double reach_db) const;
  void tabulate();

  const CalibrationCells* cells_;
  std::vector<double> range_db_;
  std::vector<double> rates_;  // 1/s over u in dB
  std::vector<bool> silent_;   // cell by cell: nothing was heard in it
  std::vector<float> tables_;  // cell by cell, over reach in dB: all that the parameters act through
};

}  // namespace forager::boards
