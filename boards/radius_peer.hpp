#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/pose.hpp"
#include "mocks/tag_grid.hpp"

namespace forager::boards {

// Another way to find the points within a radius; for comparison only.
class RadiusPeer {
 public:
  virtual ~RadiusPeer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  // Ids of all points with |point - centre| <= radius_m, in any order, instead of what `out` held.
  virtual void within(hal::Vec3 centre, double radius_m, std::vector<std::uint32_t>& out) = 0;
};

// nanoflann's k-d tree over the points, which must outlive it; built without nanoflann: a look at every one.
[[nodiscard]] std::unique_ptr<RadiusPeer> make_radius_peer(const mocks::PointSpans& points);

}  // namespace forager::boards
