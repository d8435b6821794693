#pragma once

#include <cstdint>
#include <vector>

#include "hal/random.hpp"
#include "mocks/tag_list.hpp"

namespace forager::mocks {

// What is wrong with a list that says which tag is where; shares of all tags, 0..1, together at most 1.
struct LayoutFaults {
  double mislabeled = 0.0;  // listed at the place of another one of them: labels that were swapped
  double unlisted = 0.0;    // on a shelf, but not in the list
};

// The list that somebody keeps of a world's tags. The tags themselves are where the world has them.
struct TagLayout {
  TagList tags;                           // in the world's order, those that are listed
  std::vector<std::uint32_t> mislabeled;  // indices into the world's tags, ascending
  std::vector<std::uint32_t> unlisted;    // the same
};

// Shares are rounded to whole tags; one label alone cannot be swapped, so it takes a second one. Every
// mislabeled tag is listed where another mislabeled one is, each place once. The same tags, faults and random
// numbers give the same list.
[[nodiscard]] TagLayout layout_of(const TagList& tags, const LayoutFaults& faults, hal::Random& random);

}  // namespace forager::mocks
