#pragma once

#include <functional>
#include <vector>

namespace forager::boards {

struct SimplexOptions {
  int evaluations = 200;    // at most
  double tolerance = 1e-4;  // stops when the values at the corners are nearer to each other than this
};
struct SimplexResult {
  std::vector<double> at;
  double value = 0.0;
  int evaluations = 0;
};

// Nelder-Mead with the dimension-dependent coefficients of Gao and Han (2012): a minimum of f near `from`,
// without derivatives, for functions with small jumps. `step` spans the first simplex. Not-a-number counts as
// infinitely bad.
[[nodiscard]] SimplexResult simplex_search(const std::function<double(const std::vector<double>&)>& f,
                                           const std::vector<double>& from, const std::vector<double>& step,
                                           const SimplexOptions& options = {});

}  // namespace forager::boards
