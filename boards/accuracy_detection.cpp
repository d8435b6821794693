#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "boards/accuracy_row.hpp"
#include "hal/random.hpp"
#include "mocks/detection.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kPoints = 16384;

std::vector<double> normalised_ranges(std::uint64_t seed) {
  hal::Random random(seed);
  std::vector<double> u(kPoints);
  for (double& value : u) value = std::pow(10.0, random.uniform(-4.0, 2.0));
  return u;
}

}  // namespace

std::vector<AccuracyRow> accuracy_detection(const AccuracyOptions& options) {
  const auto ranges = std::make_shared<std::vector<double>>(normalised_ranges(options.seed));
  const auto results = std::make_shared<std::vector<double>>(kPoints);
  AccuracyRow row{.name = "PD of u", .variant = "f64", .reference = "long double"};
  for (const double u : *ranges) {
    const long double exact = 2.0L / (1.0L + std::exp(static_cast<long double>(u) * std::log(3.0L)));
    const auto error = static_cast<double>(std::abs(mocks::detection_probability(u) - exact));
    row.max_abs_error = std::max(row.max_abs_error, error);
    row.max_rel_error = std::max(row.max_rel_error, error / static_cast<double>(exact));
  }
  row.items = kPoints;
  row.work = [ranges, results] {
    std::transform(ranges->begin(), ranges->end(), results->begin(), mocks::detection_probability);
  };
  return {row};
}

}  // namespace forager::boards
