#include <limits>

#include "boards/stress_case.hpp"
#include "mocks/antenna_pattern.hpp"
#include "mocks/detection.hpp"

namespace forager::boards {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

StressCase values_without_meaning() {
  Worst worst;
  for (const double u : {0.0, -0.0, 5e-324, 1e-300, 1e4, 1e300, -1.0, kInf, -kInf, kNaN}) {
    const double p = mocks::detection_probability(u);
    worst.must(p >= 0.0 && p <= 1.0);
  }
  return worst.against("detection: u that is no range", 0.0);
}

}  // namespace

std::vector<StressCase> stress_detection() { return {values_without_meaning()}; }

}  // namespace forager::boards
