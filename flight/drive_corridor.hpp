#pragma once

#include <span>
#include <vector>

#include "hal/error.hpp"
#include "hal/pose.hpp"

namespace forager::flight {

// The strip along a planned path that the middle of the vehicle may be in. World frame, metres.
class DriveCorridor {
 public:
  // Errors: invalid_argument (no point, a point that is not finite, a half width that is not positive).
  [[nodiscard]] static hal::Result<DriveCorridor> create(std::vector<hal::Vec3> path, double half_width_m);

  // Horizontal distance from the path; NaN for a place that is not finite.
  [[nodiscard]] double distance_m(hal::Vec3 at_world) const;
  // False for a place that is not finite.
  [[nodiscard]] bool contains(hal::Vec3 at_world) const { return distance_m(at_world) <= half_width_m_; }
  [[nodiscard]] double half_width_m() const { return half_width_m_; }
  [[nodiscard]] std::span<const hal::Vec3> path() const { return path_; }

 private:
  DriveCorridor(std::vector<hal::Vec3> path, double half_width_m)
      : path_(std::move(path)), half_width_m_(half_width_m) {}
  std::vector<hal::Vec3> path_;
  double half_width_m_;
};

}  // namespace forager::flight
