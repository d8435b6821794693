#include "boards/drive_campaign.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "boards/drive_plant.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

constexpr double kEarliestFault_s = 3.0;
constexpr double kLatestFault_s = 40.0;

DriveSpread spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(0.5), at(0.99), values.back()};
}

std::string end_text(const DriveResult& result) {
  return std::string(to_string(result.end)) + (result.detail.empty() ? "" : ": " + result.detail);
}

// Sums first; shares at the end.
struct Tally {
  DriveSummary summary;
  std::vector<double> position, heading, time;

  void add(const DriveScene& scene, DriveResult result) {
    DriveSummary& s = summary;
    ++s.runs;
    ++s.ends[end_text(result)];
    s.left_corridor += result.left_corridor ? 1 : 0;
    s.out_without_stop += result.out_without_stop ? 1 : 0;
    s.contacts += result.clearance_m <= 0.0 ? 1 : 0;
    s.steps += static_cast<double>(result.steps_done);
    s.turns += result.stats.turns;
    s.drives += result.stats.drives;
    s.passed += result.stats.passed;
    s.replans += result.stats.replans;
    s.holds += result.stats.holds;
    s.touches += result.stats.dabs;
    s.thrust_n_s += result.thrust_n_s;
    s.energy_j += result.energy_in_j;
    time.push_back(result.time_s);
    if (result.end == flight::DriveEnd::arrived) {
      position.push_back(result.position_error_m);
      heading.push_back(hal::rad_to_deg(result.heading_error_rad));
    }
    if (result.arrived(scene))
      ++s.arrived;
    else
      s.failures.push_back(std::move(result));
  }

  DriveSummary close() {
    DriveSummary& s = summary;
    const double n = std::max(1.0, static_cast<double>(s.runs));
    for (double* sum : {&s.steps, &s.turns, &s.drives, &s.passed, &s.replans, &s.holds, &s.touches,
                        &s.thrust_n_s, &s.energy_j})
      *sum /= n;
    s.position_m = spread(std::move(position));
    s.heading_deg = spread(std::move(heading));
    s.time_s = spread(std::move(time));
    return std::move(summary);
  }
};

void add_fault(const DriveScene& scene, DriveResult result, DriveFaultSummary& s) {
  ++s.runs;
  ++s.ends[end_text(result)];
  if (!result.struck_s) return;
  ++s.struck;
  bool safe = result.stands && !result.hung;
  if (result.detected_s) {
    ++s.detected;
    const auto reaction = result.reaction_s();
    safe = safe && reaction && *reaction <= kDriveReactionBound_s;
    s.worst_reaction_s = std::max(s.worst_reaction_s, reaction.value_or(99.0));
    s.worst_latency_s = std::max(s.worst_latency_s, *result.detected_s - *result.struck_s);
    s.worst_way_m = std::max(s.worst_way_m, result.moved_after_m);
    s.worst_turn_deg = std::max(s.worst_turn_deg, hal::rad_to_deg(result.turned_after_rad));
  } else if (result.arrived(scene)) {
    ++s.harmless;
  } else {
    ++s.ended_else;
  }
  if (safe) return;
  ++s.unsafe;
  s.failures.push_back(std::move(result));
}

}  // namespace

hal::Result<DriveSummary> run_campaign(const DriveScene& scene, const DriveCampaignOptions& options) {
  Tally tally;
  for (std::uint64_t i = 0; i < options.runs; ++i) {
    DriveRunOptions run;
    run.seed = options.first_seed + i;
    run.wire = options.wire;
    auto result = run_drive(scene, run);
    if (!result) return hal::fail(std::move(result).error());
    const bool on = !options.progress || options.progress(*result, i + 1, options.runs);
    tally.add(scene, std::move(*result));
    if (!on) break;
  }
  return tally.close();
}

hal::Result<std::vector<DriveFaultSummary>> run_fault_campaign(const DriveScene& scene,
                                                               const DriveCampaignOptions& options) {
  std::vector<DriveFaultSummary> all;
  const std::uint64_t total = options.runs * (kDriveFaults - 1);
  std::uint64_t done = 0;
  for (std::size_t kind = 1; kind < kDriveFaults; ++kind) {
    DriveFaultSummary summary;
    summary.fault = static_cast<DriveFault>(kind);
    for (std::uint64_t i = 0; i < options.runs; ++i) {
      DriveRunOptions run;
      run.seed = options.first_seed + i;
      run.wire = options.wire;
      run.fault = summary.fault;
      hal::Random random(drive_seed(run.seed + kind * 1000003U, DriveStream::fault));
      run.fault_s = random.uniform(kEarliestFault_s, kLatestFault_s);
      auto result = run_drive(scene, run);
      if (!result) return hal::fail(std::move(result).error());
      if (options.progress && !options.progress(*result, ++done, total)) return all;
      add_fault(scene, std::move(*result), summary);
    }
    all.push_back(std::move(summary));
  }
  return all;
}

}  // namespace forager::boards
