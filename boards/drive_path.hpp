#pragma once

#include <span>
#include <vector>

#include "servo/path_steps.hpp"

namespace forager::boards {

struct DrivePoint {
  double x = 0.0;
  double y = 0.0;
};

// What a planner would deliver: poses every `spacing_m` along straight lines whose corners are rounded by
// parabolas that begin `corner_m` before each corner (less where a line is short). The heading follows the
// way. At least two different points.
[[nodiscard]] std::vector<servo::PathPose> rounded_path(std::span<const DrivePoint> corners, double corner_m,
                                                        double spacing_m);

}  // namespace forager::boards
