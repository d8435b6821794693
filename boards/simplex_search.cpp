#include "boards/simplex_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace forager::boards {
namespace {

struct Corner {
  std::vector<double> at;
  double value = 0.0;
};

}  // namespace

SimplexResult simplex_search(const std::function<double(const std::vector<double>&)>& f,
                             const std::vector<double>& from, const std::vector<double>& step,
                             const SimplexOptions& options) {
  const std::size_t n = from.size();
  SimplexResult result;
  const auto corner = [&](std::vector<double> at) {
    ++result.evaluations;
    const double value = f(at);
    return Corner{std::move(at), std::isnan(value) ? std::numeric_limits<double>::infinity() : value};
  };
  std::vector<Corner> corners;
  corners.push_back(corner(from));
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> at = from;
    at[i] += step[i];
    corners.push_back(corner(std::move(at)));
  }
  const double size = static_cast<double>(std::max<std::size_t>(n, 2));
  const double expand = 1.0 + 2.0 / size;
  const double contract = 0.75 - 0.5 / size;
  const double shrink = 1.0 - 1.0 / size;
  const auto by_value = [](const Corner& a, const Corner& b) { return a.value < b.value; };
  while (n > 0) {
    std::stable_sort(corners.begin(), corners.end(), by_value);
    if (result.evaluations >= options.evaluations) break;
    if (corners.back().value - corners.front().value < options.tolerance) break;
    std::vector<double> centre(n, 0.0);
    for (std::size_t c = 0; c < n; ++c)
      for (std::size_t i = 0; i < n; ++i) centre[i] += corners[c].at[i] / static_cast<double>(n);
    // The worst corner, moved along the line through the centre of the others.
    const auto moved = [&](double factor) {
      std::vector<double> at(n);
      for (std::size_t i = 0; i < n; ++i) at[i] = centre[i] + factor * (centre[i] - corners[n].at[i]);
      return corner(std::move(at));
    };
    Corner next = moved(1.0);
    if (next.value < corners.front().value) {
      Corner farther = moved(expand);
      if (farther.value < next.value) next = std::move(farther);
    } else if (next.value >= corners[n - 1].value) {
      Corner nearer = moved(next.value < corners[n].value ? contract : -contract);
      if (nearer.value < std::min(next.value, corners[n].value)) {
        next = std::move(nearer);
      } else {
        for (std::size_t c = 1; c <= n; ++c) {
          std::vector<double> at(n);
          for (std::size_t i = 0; i < n; ++i)
            at[i] = corners[0].at[i] + shrink * (corners[c].at[i] - corners[0].at[i]);
          corners[c] = corner(std::move(at));
        }
        continue;
      }
    }
    corners[n] = std::move(next);
  }
  result.at = corners.front().at;
  result.value = corners.front().value;
  return result;
}

}  // namespace forager::boards
