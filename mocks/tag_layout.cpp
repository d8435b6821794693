#include "mocks/tag_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace forager::mocks {
namespace {

std::size_t share_of(double share, std::size_t tags) {
  return static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * static_cast<double>(tags)));
}

}  // namespace

TagLayout layout_of(const TagList& tags, const LayoutFaults& faults, hal::Random& random) {
  TagLayout layout;
  std::size_t swapped = share_of(faults.mislabeled, tags.size());
  if (swapped == 1) swapped = std::min<std::size_t>(2, tags.size());
  if (swapped < 2) swapped = 0;
  const std::size_t absent = std::min(share_of(faults.unlisted, tags.size()), tags.size() - swapped);
  if (swapped + absent == 0) {
    layout.tags = tags;
    return layout;
  }
  // The first of a shuffle, in its order.
  std::vector<std::uint32_t> chosen(tags.size());
  std::iota(chosen.begin(), chosen.end(), 0U);
  for (std::size_t i = 0; i < swapped + absent; ++i)
    std::swap(chosen[i], chosen[i + random.below(chosen.size() - i)]);
  const auto middle = chosen.begin() + static_cast<std::ptrdiff_t>(swapped);
  layout.mislabeled.assign(chosen.begin(), middle);
  layout.unlisted.assign(middle, middle + static_cast<std::ptrdiff_t>(absent));

  // A random cycle leaves nobody in place.
  std::vector<std::uint32_t> place(tags.size());
  std::iota(place.begin(), place.end(), 0U);
  for (std::size_t i = 0; i < swapped; ++i)
    place[layout.mislabeled[i]] = layout.mislabeled[(i + 1) % swapped];
  std::sort(layout.mislabeled.begin(), layout.mislabeled.end());
  std::sort(layout.unlisted.begin(), layout.unlisted.end());

  layout.tags.reserve(tags.size() - absent);
  auto next_absent = layout.unlisted.begin();
  for (std::size_t tag = 0; tag < tags.size(); ++tag) {
    if (next_absent != layout.unlisted.end() && *next_absent == tag) {
      ++next_absent;
      continue;
    }
    const hal::Vec3 at = tags.position(place[tag]);
    if (const Epc96* const epc = tags.epc96(tag))
      layout.tags.add(*epc, at, tags.wanted(tag));
    else
      layout.tags.push_back({tags.epc_hex(tag), at, tags.wanted(tag)});
  }
  return layout;
}

}  // namespace forager::mocks
