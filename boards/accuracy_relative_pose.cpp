#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "boards/accuracy_row.hpp"
#include "boards/wide.hpp"
#include "flight/relative_pose.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"

// The angle between two robots' maps, from what each saw. The reference solves the same sighting to 100 bits,
// so that only the formula is judged, not the noise of the sighting. An answer fails when there is none or it
// is more than a thousandth of a radian off.
namespace forager::boards {
namespace {

using flight::MutualSighting;
using Sightings = std::vector<MutualSighting>;

constexpr double kFailsFromRad = 1e-3;
constexpr std::size_t kTimed = 4096;

double closed_form(const MutualSighting& s) {
  static constexpr flight::RelativePoseConfig kAnything{.distance_tolerance_m = 1e6, .min_distance_m = 0.0};
  return flight::relative_pose(s, kAnything).phi_rad;
}

double single_precision(const MutualSighting& s) {
  const auto px = static_cast<float>(s.pawn_seen.x_m - s.detector_itself.x_m);
  const auto py = static_cast<float>(s.pawn_seen.y_m - s.detector_itself.y_m);
  const auto qx = static_cast<float>(s.detector_seen.x_m - s.pawn_itself.x_m);
  const auto qy = static_cast<float>(s.detector_seen.y_m - s.pawn_itself.y_m);
  return static_cast<double>(std::atan2(px * qy - py * qx, -(px * qx + py * qy)));
}

// Equations 5.17 and 5.18: both angles of the arccosine against the arcsine, the one that matches to a degree
// is the answer. With r_D0 = -p. NaN: none matches, or one of them is not a number.
double as_published(const MutualSighting& s) {
  const double x0 = -(s.pawn_seen.x_m - s.detector_itself.x_m);
  const double y0 = -(s.pawn_seen.y_m - s.detector_itself.y_m);
  const double x = s.detector_seen.x_m - s.pawn_itself.x_m;
  const double y = s.detector_seen.y_m - s.pawn_itself.y_m;
  const double squared = x0 * x0 + y0 * y0;
  const double by_cosine = std::acos((x0 * x + y0 * y) / squared);
  const double by_sine = std::asin((y0 * x - x0 * y) / squared);
  const double phi = std::abs(by_cosine - by_sine) <= std::abs(-by_cosine - by_sine) ? by_cosine : -by_cosine;
  return std::abs(phi - by_sine) <= hal::deg_to_rad(1.0) ? phi : NAN;
}

Wide exactly(const MutualSighting& s) {
  const Wide px = Wide(s.pawn_seen.x_m) - Wide(s.detector_itself.x_m);
  const Wide py = Wide(s.pawn_seen.y_m) - Wide(s.detector_itself.y_m);
  const Wide qx = Wide(s.detector_seen.x_m) - Wide(s.pawn_itself.x_m);
  const Wide qy = Wide(s.detector_seen.y_m) - Wide(s.pawn_itself.y_m);
  return atan2(px * qy - py * qx, -(px * qx + py * qy));
}

// Every relative angle, 0.5 to 5 m apart; noise_m: of each of the two seen positions.
Sightings sightings(std::size_t count, std::uint64_t seed, double noise_m) {
  hal::Random random(seed);
  Sightings out(count);
  for (MutualSighting& s : out) {
    const double phi = random.uniform(-hal::kPi, hal::kPi);
    const double bearing = random.uniform(-hal::kPi, hal::kPi);
    const double range_m = random.uniform(0.5, 5.0);
    s.pawn_seen = {range_m * std::cos(bearing) + noise_m * random.normal(),
                   range_m * std::sin(bearing) + noise_m * random.normal()};
    s.detector_seen = {-range_m * std::cos(bearing - phi) + noise_m * random.normal(),
                       -range_m * std::sin(bearing - phi) + noise_m * random.normal()};
  }
  return out;
}

AccuracyRow row(const std::string& name, std::string variant, const std::shared_ptr<Sightings>& inputs,
                double (*solve)(const MutualSighting&)) {
  AccuracyRow out{.name = name, .variant = std::move(variant), .reference = "the same sighting to 100 bits"};
  for (const MutualSighting& sighting : *inputs) {
    const Wide exact = exactly(sighting);
    const double off = (Wide(solve(sighting)) - exact).rounded();
    const double error = std::abs(off) > hal::kPi ? std::abs(2.0 * hal::kPi - std::abs(off)) : std::abs(off);
    ++out.asked;
    if (!(error <= kFailsFromRad)) ++out.failures;
    if (!std::isfinite(error)) continue;
    out.max_abs_error = std::max(out.max_abs_error, error);
    out.max_rel_error = std::max(out.max_rel_error, error / std::abs(exact.high));
  }
  const auto sink = std::make_shared<double>(0.0);
  out.items = static_cast<double>(std::min(kTimed, inputs->size()));
  out.work = [inputs, solve, sink] {
    for (std::size_t i = 0; i < std::min(kTimed, inputs->size()); ++i) *sink += solve((*inputs)[i]);
  };
  return out;
}

}  // namespace

std::vector<AccuracyRow> accuracy_relative_pose(const AccuracyOptions& options) {
  const auto count = static_cast<std::size_t>(std::max(400.0, 100'000.0 * options.effort));
  std::vector<AccuracyRow> rows;
  for (const double noise_m : {0.0, 0.05}) {
    const std::string name = noise_m > 0.0 ? "relative pose: angle, radians, sightings 5 cm off"
                                           : "relative pose: angle, radians, true sightings";
    const auto inputs = std::make_shared<Sightings>(sightings(count, options.seed, noise_m));
    rows.push_back(row(name, "atan2, f64 with pose and sigma", inputs, closed_form));
    rows.push_back(row(name, "atan2, f32", inputs, single_precision));
    rows.push_back(row(name, "as published (5.17, 5.18), f64", inputs, as_published));
  }
  return rows;
}

}  // namespace forager::boards
