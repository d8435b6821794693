#pragma once

#include <vector>

#include "hal/pose.hpp"
#include "mocks/tag_list.hpp"

namespace forager::mocks {

// Upright box, axis-aligned in the world frame, metres.
struct Box {
  hal::Vec3 min;
  hal::Vec3 max;
};

// A warehouse: what stands in it (seen by the depth camera, in the way of the vehicle, optionally in the way
// of radio waves) and the tags in it. The floor is the plane z = 0.
struct World {
  std::vector<Box> obstacles;
  TagList tags;
};

}  // namespace forager::mocks
