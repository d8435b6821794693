#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "reader/inventory_store.hpp"

namespace forager::mocks {
class TagList;
}

namespace forager::boards {

// Farther from its listed place than this a tag is not at it: what SP11 antennas reach, and some.
inline constexpr double kLayoutReach_m = 5.0;

// An inventory held against a list of where the tags should be.
struct LayoutCheck {
  // A tag heard strongest from where its listed place is out of reach.
  struct Elsewhere {
    reader::Epc epc;
    hal::Vec3 listed;
    hal::Vec3 heard_from;  // the vehicle at the strongest read
    double away_m = 0.0;   // between the two
  };
  std::vector<Elsewhere> elsewhere;    // farthest first
  std::vector<reader::Epc> strangers;  // heard, but not listed
  std::size_t listed = 0;
  std::size_t in_place = 0;  // heard within reach of their place
  std::size_t unplaced = 0;  // heard, but no pose is known for their strongest read
  std::size_t unheard = 0;   // listed, but not in the inventory
};

// Linear in items and tags. A label that was swapped over less than twice the reach may pass for one in
// place; where a tag was heard it is to be sought within the reach.
[[nodiscard]] LayoutCheck check_layout(const std::vector<reader::InventoryItem>& items,
                                       const mocks::TagList& layout, double reach_m = kLayoutReach_m);

// The same against a tag file (docs/boards.md). Errors: those of reading it.
[[nodiscard]] hal::Result<LayoutCheck> check_layout_file(const std::vector<reader::InventoryItem>& items,
                                                         const std::string& path,
                                                         double reach_m = kLayoutReach_m);

}  // namespace forager::boards
