#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/pose.hpp"

namespace forager::mocks {

// Upright box, axis-aligned in the world frame, metres.
struct Box {
  hal::Vec3 min;
  hal::Vec3 max;
};

struct Tag {
  std::string epc_hex;  // lower case
  hal::Vec3 position;
  bool wanted = true;  // false: a bystander that belongs to nobody's inventory
};

// A warehouse: what stands in it (seen by the depth camera, in the way of the vehicle, optionally in the way
// of radio waves) and the tags in it. The floor is the plane z = 0.
struct World {
  std::vector<Box> obstacles;
  std::vector<Tag> tags;
};

}  // namespace forager::mocks
