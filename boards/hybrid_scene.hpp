#pragma once

#include <string>
#include <vector>

#include "boards/config_node.hpp"
#include "boards/drive_scene.hpp"
#include "flight/hybrid_energy.hpp"
#include "flight/hybrid_mode.hpp"
#include "flight/hybrid_route.hpp"
#include "hal/error.hpp"

namespace forager::boards {

// A drive scene whose vehicle may also fly: its path is places to pass rather than a line to follow, and its
// obstacles have heights.
struct HybridScene {
  DriveScene drive;
  std::vector<hal::Vec3> places;  // start first
  std::vector<flight::HopObstacle> obstacles;
  flight::HybridRouteConfig route;
  flight::EnergyAssumptions energy;
  double flight_m_s = 0.5;
};

// Whether the file has a table [hybrid]; false too if it cannot be read.
[[nodiscard]] bool is_hybrid_scene(const std::string& path);

// Errors: those of load_drive_scene.
[[nodiscard]] hal::Result<HybridScene> load_hybrid_scene(const std::string& path);
[[nodiscard]] hal::Result<HybridScene> read_hybrid_scene(const ConfigNode& root, const std::string& file);

}  // namespace forager::boards
