#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "boards/drive_run.hpp"

namespace forager::boards {

// Many seeded runs of one scene.
struct DriveCampaignOptions {
  std::uint64_t first_seed = 1;
  std::uint64_t runs = 1;
  bool wire = false;
  bool faults = false;  // `runs` of each kind of fault instead of runs without
  // Told after each run; false ends the campaign.
  std::function<bool(const DriveResult&, std::uint64_t done, std::uint64_t all)> progress;
};

// One line of the closing table.
struct DriveSpread {
  double median = 0.0;
  double p99 = 0.0;
  double worst = 0.0;
};

struct DriveSummary {
  std::uint64_t runs = 0;
  std::uint64_t arrived = 0;        // within both margins, inside the corridor, without contact, standing
  std::uint64_t left_corridor = 0;  // and stopped for it
  std::uint64_t out_without_stop = 0;
  std::uint64_t contacts = 0;
  DriveSpread position_m;  // of the runs that ended at the goal
  DriveSpread heading_deg;
  DriveSpread time_s;
  double steps = 0.0;  // means per run
  double turns = 0.0;
  double drives = 0.0;
  double passed = 0.0;
  double replans = 0.0;
  double holds = 0.0;
  double touches = 0.0;
  double thrust_n_s = 0.0;
  double energy_j = 0.0;
  std::map<std::string, std::uint64_t> ends;  // "arrived: at the goal" -> how often
  std::vector<DriveResult> failures;          // runs that did not arrive, in order
};

// How one kind of fault went.
struct DriveFaultSummary {
  DriveFault fault = DriveFault::none;
  std::uint64_t runs = 0;
  std::uint64_t struck = 0;
  std::uint64_t detected = 0;
  std::uint64_t harmless = 0;     // not noticed, arrived within its margins all the same
  std::uint64_t ended_else = 0;   // not noticed as such, ended safely for another reason
  std::uint64_t unsafe = 0;       // safe too late or never, or does not stand at the end
  double worst_reaction_s = 0.0;  // from detection to safe
  double worst_latency_s = 0.0;   // from the fault to its detection
  double worst_way_m = 0.0;       // rolled after detection
  double worst_turn_deg = 0.0;    // turned after detection
  std::map<std::string, std::uint64_t> ends;
  std::vector<DriveResult> failures;
};

// The stated bound: thrust cut and brakes gripping within this of detection.
inline constexpr double kDriveReactionBound_s = 0.3;

// Errors: those of run_drive().
[[nodiscard]] hal::Result<DriveSummary> run_campaign(const DriveScene& scene,
                                                     const DriveCampaignOptions& options);
[[nodiscard]] hal::Result<std::vector<DriveFaultSummary>> run_fault_campaign(
    const DriveScene& scene, const DriveCampaignOptions& options);

}  // namespace forager::boards
