#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <vector>

#include "boards/detection_truth.hpp"
#include "boards/speed_contest.hpp"
#include "hal/random.hpp"
#include "mocks/detection_kernel.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kPairs = 16384;
constexpr double kReach_m = 8.0;
constexpr double kR0_m = 2.4;

// The formula of the laboratory's published plugin as it is written there, arc cosines, cosines, power and
// all; but with pi in full, where it had 3.1415, and with the null it left out.
double as_written(double x, double y, double z, double width_rad) {
  if (!(x > 0.0)) return 0.0;
  const double h = std::acos(x / std::hypot(x, y));
  const double v = std::acos(x / std::hypot(x, z));
  if (h >= width_rad || v >= width_rad) return 0.0;
  const double cos_h = std::cos(hal::kPi / 2.0 * h / width_rad);
  const double cos_v = std::cos(hal::kPi / 2.0 * v / width_rad);
  const double pattern = cos_h * cos_h * cos_v * cos_v;
  const double ratio = std::hypot(x, y) / (pattern * kR0_m);
  return 2.0 / (1.0 + std::pow(3.0, std::sqrt(ratio * ratio)));
}

// The same pairs of tag and antenna for both, of coordinates of our type.
template <class T>
struct Contest {
  double width_rad;
  double most_error;
  mocks::DetectionKernel kernel;
  std::vector<T> x, y, z, ours_found;
  std::vector<double> other_found;

  Contest(double width_deg, double allowed)
      : width_rad(hal::deg_to_rad(width_deg)),
        most_error(allowed),
        kernel({mocks::AntennaPattern::cosine_squared(width_rad, width_rad), kR0_m,
                mocks::DetectionFormula::plugin_as_published}),
        ours_found(kPairs),
        other_found(kPairs) {
    hal::Random random(7);
    for (auto* axis : {&x, &y, &z})
      for (std::size_t i = 0; i < kPairs; ++i)
        axis->push_back(static_cast<T>(random.uniform(-kReach_m, kReach_m)));
  }
  void ours() {
    kernel.probabilities(x, y, z, ours_found);
    keep_result(ours_found.data());
  }
  void other() {
    for (std::size_t i = 0; i < kPairs; ++i)
      other_found[i] = as_written(static_cast<double>(x[i]), static_cast<double>(y[i]),
                                  static_cast<double>(z[i]), width_rad);
    keep_result(other_found.data());
  }
  // Both against the exact value, not against each other.
  bool agree() {
    ours();
    other();
    for (std::size_t i = 0; i < kPairs; ++i) {
      const double exact =
          exact_detection({static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])},
                          {width_rad, width_rad, kR0_m, kernel.settings().formula});
      if (!(std::abs(static_cast<double>(ours_found[i]) - exact) <= most_error)) return false;
      if (!(std::abs(other_found[i] - exact) <= 1e-15)) return false;
    }
    return true;
  }
};

template <class T>
SpeedContest contest(double width_deg, const char* type, double allowed) {
  const auto pairs = std::make_shared<Contest<T>>(width_deg, allowed);
  return {.name = fmt::format("detection {} deg, {} to {:g}", width_deg, type, allowed),
          .unit = "pairs/s",
          .peer = "formula as written, f64",
          .items = kPairs,
          .ours = [pairs] { pairs->ours(); },
          .other = [pairs] { pairs->other(); },
          .agree = [pairs] { return pairs->agree(); }};
}

}  // namespace

std::vector<SpeedContest> speed_detection() {
  return {contest<double>(70.0, "f64", 1e-15), contest<float>(70.0, "f32", 2e-7),
          contest<double>(90.0, "f64", 1e-15), contest<float>(90.0, "f32", 2e-7)};
}

}  // namespace forager::boards
