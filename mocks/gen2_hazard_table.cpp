#include "mocks/gen2_hazard_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mocks/detection.hpp"

namespace forager::mocks {
namespace {

constexpr double kLn3 = 1.0986122886681098;
// The rates have a few roundings of their own; the bound stays above them.
constexpr double kAbove = 1.0 + 1e-12;

// Where -ln tanh(u ln3 / 2) falls to the cut.
double range_of(double cut) {
  if (!(cut > 0.0)) return std::numeric_limits<double>::infinity();
  return (std::log1p(std::exp(-cut)) - std::log(-std::expm1(-cut))) / kLn3;
}

}  // namespace

HazardTable::HazardTable(const AirParameters& air)
    : last_u_(std::min(air.power_up_limit, range_of(air.hazard_cut))),
      tail_(expected_answers(kLongest) / air.t0_s * kAbove) {
  const auto steps = static_cast<std::size_t>(std::min(last_u_, kLongest) * kStepsPerU) + 1;
  for (std::size_t i = 0; i < steps; ++i) {
    const double u = static_cast<double>(i) / kStepsPerU;
    rates_.push_back(expected_answers(std::max(u, kNearestU)) / air.t0_s * kAbove);
  }
}

}  // namespace forager::mocks
