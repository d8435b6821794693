#include "boards/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "boards/calibration_profile.hpp"
#include "boards/reproduce.hpp"

namespace forager::boards {
namespace {

using namespace calibration;

constexpr std::uint64_t kFewestReads = 100;
constexpr std::size_t kFewestTags = 10;
// Ranges must differ by this factor between the 5 and 95 % points of what was heard.
constexpr double kRangeFactor = 1.2;

hal::Failure refuse(std::string which, std::string why, std::string mend) {
  return hal::fail(hal::ErrorCode::refused, "recording", fmt::format("tell {}", which), std::move(why),
                   std::move(mend));
}

hal::Result<> check_recording(const Recording& recording, const CalibrationCells& cells,
                              const CalibrationOptions& options) {
  if (recording.poses.size() < 2)
    return refuse("r0_m", "there are fewer than two poses", "Record poses along with the reads.");
  std::size_t tags = 0;
  for (std::size_t tag = 0; tag + 1 < cells.tag_begin.size(); ++tag)
    if (cells.tag_begin[tag] != cells.tag_begin[tag + 1]) ++tags;
  if (cells.reads < kFewestReads)
    return refuse("r0_m, spread_db, rician_k_db",
                  fmt::format("only {} reads of known tags while poses are known", cells.reads),
                  fmt::format("It takes {} at least.", kFewestReads));
  if (tags < kFewestTags)
    return refuse("spread_db", fmt::format("only {} tags came before an antenna", tags),
                  fmt::format("It takes {} at least.", kFewestTags));
  if (cells.farthest_m < kRangeFactor * cells.nearest_m)
    return refuse("r0_m",
                  fmt::format("all tags were heard at about one range, {:.2f} to {:.2f} m on boresight",
                              cells.nearest_m, cells.farthest_m),
                  "Record tags at ranges that differ by half or more.");
  if (cells.seen_slices > 0.99 * cells.slices)
    return refuse("r0_m", "every tag was heard all the time: R0 has no upper bound",
                  "Record from farther away, or with less power.");
  if (!options.rician_k_db && cells.moved_m < 2.0 * options.slicing.fade_length_m)
    return refuse(
        "rician_k_db",
        fmt::format("the vehicle moved by {:.2f} m only: each tag showed one fade, which looks like its "
                    "sensitivity",
                    cells.moved_m),
        "Record a moving vehicle, or hold rician_k_db at a value.");
  return {};
}

std::vector<CalibrationResidual> residuals_of(const CalibrationCells& cells,
                                              const CalibrationLikelihood& likelihood,
                                              const CalibrationParameters& p) {
  constexpr std::size_t kSpans = 10;
  const std::vector<double> expected = likelihood.expected_seen(p);
  std::vector<double> ranges;
  for (const CalibrationBin& bin : cells.bins) ranges.push_back(bin.range_m);
  std::vector<CalibrationResidual> out;
  for (std::size_t span = 0; span < kSpans; ++span) {
    CalibrationResidual r;
    r.from_m = span == 0 ? 0.0 : out.back().to_m;
    r.to_m = quantile(ranges, static_cast<double>(span + 1) / kSpans);
    double variance = 0.0;
    for (std::size_t b = 0; b < cells.bins.size(); ++b) {
      const CalibrationBin& bin = cells.bins[b];
      if (bin.range_m <= r.from_m || bin.range_m > r.to_m) continue;
      const double slices = bin.seen + bin.unseen;
      r.slices += slices;
      r.seen += bin.seen;
      r.expected += expected[b];
      variance += expected[b] * (1.0 - std::min(expected[b] / slices, 1.0));
    }
    r.standardised = variance > 0.0 ? (r.seen - r.expected) / std::sqrt(variance) : 0.0;
    out.push_back(r);
  }
  return out;
}

std::vector<MisplacedTag> misplaced_of(const Recording& recording, const CalibrationCells& cells) {
  std::vector<MisplacedTag> out;
  for (const std::uint32_t tag : cells.misplaced) {
    MisplacedTag found{recording.tags[tag].epc, recording.tags[tag].position, {}, 0};
    double strongest_dbm = -std::numeric_limits<double>::infinity();
    for (const Recording::Read& read : recording.reads) {
      if (read.tag != tag) continue;
      ++found.reads;
      if (read.rssi_dbm <= strongest_dbm) continue;
      strongest_dbm = read.rssi_dbm;
      const auto after = std::lower_bound(recording.poses.begin(), recording.poses.end(), read.time_s,
                                          [](const auto& p, double t) { return p.time_s < t; });
      found.heard_from = (after == recording.poses.end() ? recording.poses.back() : *after).pose.position;
    }
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace

hal::Result<Calibration> calibrate(const Recording& recording, const Scene& scene,
                                   const CalibrationOptions& options) {
  const CalibrationCells cells = cells_of(recording, scene, options.slicing);
  FORAGER_TRY(check_recording(recording, cells, options));
  const CalibrationLikelihood likelihood(cells, scene.world.radio.t0_s, scene.world.radio.power_up_limit);
  Fitter fitter(likelihood);
  const std::array<bool, kParameters> held{false, options.spread_db.has_value(),
                                           options.rician_k_db.has_value()};
  const Point given{0.0, options.spread_db.value_or(0.0), options.rician_k_db.value_or(0.0)};
  Fitter::Best best = fit_all(fitter, cells, held, given);
  const Bend bend = polish(fitter, best, held);
  const Point excess = excess_variance(fitter, best, bend);
  Calibration result;
  for (std::size_t i = 0; i < kParameters; ++i) {
    FittedParameter p;
    p.name = kNames[i];
    p.unit = kUnits[i];
    p.value = p.low = p.high = best.at[i];
    p.held = held[i];
    if (!held[i]) {
      p.low = interval_end(fitter, best, bend, held, i, -1.0, excess[i], p.open_low);
      p.high = interval_end(fitter, best, bend, held, i, 1.0, excess[i], p.open_high);
      if (p.open_low && p.open_high)
        return refuse(p.name, "the likelihood does not depend on it: its information is singular",
                      "Record more, from more places.");
    }
    if (i == 0) {
      if (p.open_low || p.open_high)
        return refuse(p.name, p.open_high ? "it has no upper bound" : "it has no lower bound",
                      "Record ranges at which some tags answer and some do not.");
      p.value = std::exp(p.value);
      p.low = std::exp(p.low);
      p.high = std::exp(p.high);
    }
    result.parameters.push_back(std::move(p));
  }
  result.residuals = residuals_of(cells, likelihood, parameters_at(best.at));
  result.misplaced = misplaced_of(recording, cells);
  result.log_likelihood = best.log_likelihood;
  result.evaluations = fitter.evaluations();
  result.tags = recording.tags.size();
  result.reads = cells.reads;
  result.strangers = recording.strangers;
  return result;
}

hal::Result<std::array<double, 3>> profile_losses(const Recording& recording, const Scene& scene,
                                                  const CalibrationParameters& truth) {
  const CalibrationCells cells = cells_of(recording, scene);
  FORAGER_TRY(check_recording(recording, cells, {}));
  const CalibrationLikelihood likelihood(cells, scene.world.radio.t0_s, scene.world.radio.power_up_limit);
  Fitter fitter(likelihood);
  Fitter::Best best = fit_all(fitter, cells, {}, {});
  const Bend bend = polish(fitter, best, {});
  const Point excess = excess_variance(fitter, best, bend);
  std::array<double, 3> losses{};
  for (std::size_t i = 0; i < kParameters; ++i)
    losses[i] = profile_loss(fitter, best, bend, {}, i, point_of(truth)[i]) / excess[i];
  return losses;
}

}  // namespace forager::boards
