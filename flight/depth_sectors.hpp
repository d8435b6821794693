#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "flight/obstacle_guard.hpp"
#include "hal/depth_source.hpp"

namespace forager::flight {

// A slice of the camera's view, from left to right.
struct DepthSector {
  double left_rad = 0.0;  // its edges in the camera's frame, positive left
  double right_rad = 0.0;
  std::uint32_t pixels = 0;
  std::uint32_t valid = 0;  // that measured something
  std::optional<double>
      nearest_m;  // depth of the k-th nearest point at the height of the body; nothing: none
};

// A depth frame for the eyes of a person: what stands how near in which direction, at the height of the body
// (the guard's band above and below the camera, which is taken to be level) and at any distance to the side.
// Unknown pixels as ObstacleGuard has them; the k of its config. A value at the sensor's maximum is "free as
// far as it reaches" and no point. Empty for a frame whose pixels do not match its model, or for less than
// one sector.
[[nodiscard]] std::vector<DepthSector> depth_sectors(const hal::DepthFrame& frame, const GuardConfig& config,
                                                     int sectors);

}  // namespace forager::flight
