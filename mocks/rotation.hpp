#pragma once

#include <cmath>

#include "hal/pose.hpp"

namespace forager::mocks {

// The axes of a frame, seen in its parent frame.
struct Axes {
  hal::Vec3 x;
  hal::Vec3 y;
  hal::Vec3 z;

  // A vector of this frame in the parent frame, and back.
  [[nodiscard]] constexpr hal::Vec3 to_parent(hal::Vec3 v) const { return v.x * x + v.y * y + v.z * z; }
  [[nodiscard]] constexpr hal::Vec3 from_parent(hal::Vec3 v) const {
    return {dot(x, v), dot(y, v), dot(z, v)};
  }

  [[nodiscard]] static constexpr double dot(hal::Vec3 a, hal::Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
};

// Rz(yaw) Ry(pitch) Rx(roll), REP-103: the attitude of hal::Pose.
[[nodiscard]] inline Axes axes_of(const hal::Pose& pose) {
  const double cy = std::cos(pose.yaw_rad);
  const double sy = std::sin(pose.yaw_rad);
  const double cp = std::cos(pose.pitch_rad);
  const double sp = std::sin(pose.pitch_rad);
  const double cr = std::cos(pose.roll_rad);
  const double sr = std::sin(pose.roll_rad);
  return {{cy * cp, sy * cp, -sp},
          {cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr},
          {cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr}};
}

// The axes of a frame mounted on another: child seen in the grandparent.
[[nodiscard]] constexpr Axes compose(const Axes& parent, const Axes& child) {
  return {parent.to_parent(child.x), parent.to_parent(child.y), parent.to_parent(child.z)};
}

}  // namespace forager::mocks
