#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/error.hpp"
#include "hal/random.hpp"
#include "mocks/warehouse.hpp"
#include "mocks/world.hpp"

namespace forager::mocks {

enum class StoreKind : std::uint8_t {
  aisles,  // parallel aisles along x, racks with passages between them
  t,       // a stem along x into an aisle across it, shelves on both sides
  square,  // an aisle round a block, shelves on both sides
  halls,   // rooms of aisles one behind the other, walls with a doorway between them
  random,  // single racks, each somewhere in a plot of its own, along x or y, some full and some nearly empty
};

// A made-up store. The place (0, 0), looking along +x, is always free: the way in. Tags scatter evenly over
// the shelves, from 0.3 m up to their height.
struct StorePlan {
  StoreKind kind = StoreKind::aisles;
  std::size_t tags = 1000;
  double tags_per_m2 = 25.0;  // over the ground plan, aisles included
  double aisle_m = 2.5;       // between the faces of shelves
  double shelf_depth_m = 0.8;
  double shelf_height_m = 2.0;
  hal::Vec3 origin = {};  // of the whole store in the world
};

// Adds shelves and exactly plan.tags tags. The same plan and random numbers give the same store. Errors:
// invalid_argument (a length or density not above 0, so few tags a square metre that the store exceeds 1e5
// m).
[[nodiscard]] hal::Result<> add_store(World& world, const StorePlan& plan, EpcSequence& epcs,
                                      hal::Random& random);

}  // namespace forager::mocks
