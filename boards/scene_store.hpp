#pragma once

#include <cstdint>
#include <string>

namespace forager::boards {

// A store made up off-target ([world.generate]).
struct SceneStore {
  std::string kind;  // aisles, t, square, halls, random
  std::uint32_t tags = 1000;
  double tags_per_m2 = 25.0;
  double aisle_m = 2.5;
  double shelf_depth_m = 0.8;
  double shelf_height_m = 2.0;
  bool operator==(const SceneStore&) const = default;
};

// What the simulated air leaves out ([world.skip]); mocks/gen2_field_parameters.hpp says at what cost.
struct SceneSkip {
  double hazard_cut = 1e-6;
  bool grid = true;
  bool behind = true;
  bool blind_antennas = true;
  bool silent = true;
  double unchanged_m = 0.005;
  double unchanged_rad = 0.005;
  bool operator==(const SceneSkip&) const = default;
};

}  // namespace forager::boards
