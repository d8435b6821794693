#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "flight/hop_planner.hpp"
#include "hal/pose.hpp"

namespace forager::flight {

// Where the vehicle may roll. World frame.
struct GroundArea {
  double min_x = -std::numeric_limits<double>::infinity();
  double min_y = -std::numeric_limits<double>::infinity();
  double max_x = std::numeric_limits<double>::infinity();
  double max_y = std::numeric_limits<double>::infinity();
};

// The shortest way on the ground past the obstacles, as corners from `from` to `to`: through the corners of
// the boxes, each grown on all sides by half_width_m (a little longer than round the true outline, never
// nearer). Nothing if there is none inside the area, or an end is not free. All pairs are looked at: for tens
// of obstacles, not thousands.
[[nodiscard]] std::optional<std::vector<hal::Vec3>> ground_detour(hal::Vec3 from_world, hal::Vec3 to_world,
                                                                  std::span<const HopObstacle> obstacles,
                                                                  double half_width_m,
                                                                  const GroundArea& area);

}  // namespace forager::flight
