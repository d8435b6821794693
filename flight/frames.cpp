#include "flight/frames.hpp"

#include <algorithm>
#include <cmath>

namespace forager::flight {

Rotation Rotation::inverse() const { return {{m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}}; }

hal::Vec3 Rotation::operator*(hal::Vec3 v) const {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

Rotation Rotation::operator*(const Rotation& inner) const {
  Rotation product;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      product.m[3 * row + column] = m[3 * row] * inner.m[column] + m[3 * row + 1] * inner.m[3 + column] +
                                    m[3 * row + 2] * inner.m[6 + column];
  return product;
}

Rotation rotation_of(const hal::Pose& pose) {
  const double cy = std::cos(pose.yaw_rad);
  const double sy = std::sin(pose.yaw_rad);
  const double cp = std::cos(pose.pitch_rad);
  const double sp = std::sin(pose.pitch_rad);
  const double cr = std::cos(pose.roll_rad);
  const double sr = std::sin(pose.roll_rad);
  return {{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
           sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,  //
           -sp, cp * sr, cp * cr}};
}

hal::Pose pose_from(hal::Vec3 position, const Rotation& rotation) {
  const auto& m = rotation.m;
  hal::Pose pose;
  pose.position = position;
  pose.pitch_rad = std::asin(std::clamp(-m[6], -1.0, 1.0));
  // Within about 1e-6 rad of the vertical the two small numbers below are rounding noise.
  if (std::hypot(m[0], m[3]) < 1e-6) {
    pose.yaw_rad = hal::wrap_pi(std::atan2(-m[1], m[4]));
    return pose;
  }
  pose.yaw_rad = hal::wrap_pi(std::atan2(m[3], m[0]));
  pose.roll_rad = hal::wrap_pi(std::atan2(m[7], m[8]));
  return pose;
}

hal::Pose take_out_mount(const hal::Pose& camera_in_world, const hal::Pose& camera_on_body) {
  const Rotation body = rotation_of(camera_in_world) * rotation_of(camera_on_body).inverse();
  return pose_from(camera_in_world.position - body * camera_on_body.position, body);
}

}  // namespace forager::flight
