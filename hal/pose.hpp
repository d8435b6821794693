#pragma once

#include <cmath>

namespace forager::hal {

// Metres. Frame by the name of the variable that holds it: _world (fixed, REP-103: x forward at start, y
// left, z up) or _body (x forward, y left, z up).
struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator*(double k, Vec3 a) { return {k * a.x, k * a.y, k * a.z}; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

[[nodiscard]] inline double norm(Vec3 v) { return std::hypot(v.x, v.y, v.z); }
[[nodiscard]] inline double distance_xy(Vec3 a, Vec3 b) { return std::hypot(a.x - b.x, a.y - b.y); }
[[nodiscard]] inline bool is_finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Position in the world frame and intrinsic z-y'-x'' (yaw, pitch, roll) attitude, radians, REP-103: positive
// yaw turns left, positive pitch lowers the nose, positive roll lifts the left side... seen along +y and +x
// by the right hand rule.
struct Pose {
  Vec3 position;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double roll_rad = 0.0;
  bool operator==(const Pose&) const = default;
};

// A horizontal vector in the body's heading frame turned into the world by yaw alone, and back.
[[nodiscard]] inline Vec3 rotate_yaw(Vec3 v, double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * v.x - s * v.y, s * v.x + c * v.y, v.z};
}

}  // namespace forager::hal
