#pragma once

#include <string>
#include <vector>

#include "boards/drive_campaign.hpp"

namespace forager::tools {

// The closing tables, for people and as one JSON line each.
[[nodiscard]] std::string drive_table(const boards::DriveScene& scene, const boards::DriveSummary& summary,
                                      double wall_s);
[[nodiscard]] std::string drive_json(const boards::DriveScene& scene, const boards::DriveSummary& summary,
                                     double wall_s);
[[nodiscard]] std::string fault_table(const boards::DriveScene& scene,
                                      const std::vector<boards::DriveFaultSummary>& faults, double wall_s);
[[nodiscard]] std::string fault_json(const boards::DriveScene& scene,
                                     const std::vector<boards::DriveFaultSummary>& faults, double wall_s);

// One self-contained page with a map of one run: path, steps, corridor, obstacles, the way it took.
[[nodiscard]] std::string drive_page(const boards::DriveScene& scene, const boards::DriveResult& run);

}  // namespace forager::tools
