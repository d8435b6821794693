#pragma once

#include <array>

#include "hal/pose.hpp"
#include "hal/units.hpp"

// The two families of frames. Ours is REP-103: world x forward at the start, y left, z up; body x forward, y
// left, z up. The autopilot's is NED with an FRD body: x forward, y right, z down. Both bodies, and both
// worlds, differ by half a turn about x, so the autopilot's local "north" is our forward at the start:
// indoors there is no better north, and the external pose is the yaw source (EK3_SRC1_YAW = 6).
// A half turn about x on both sides of Rz(yaw) Ry(pitch) Rx(roll) leaves roll and negates pitch and yaw.
namespace forager::flight {

// World to NED, body to FRD, and back: the same half turn each way.
[[nodiscard]] constexpr hal::Vec3 flip_yz(hal::Vec3 v) { return {v.x, -v.y, -v.z}; }

// An angle or rate about z or y in the other family, radians; (-pi, pi] stays (-pi, pi].
[[nodiscard]] inline double flip_angle(double angle_rad) { return hal::wrap_pi(-angle_rad); }

// Pose of the body in the other family's world, angles in (-pi, pi].
[[nodiscard]] inline hal::Pose flip_pose(const hal::Pose& pose) {
  return {flip_yz(pose.position), flip_angle(pose.yaw_rad), -pose.pitch_rad, hal::wrap_pi(pose.roll_rad)};
}

// Rotation matrix, row-major; takes vectors from the turned frame into the outer one.
struct Rotation {
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};

  [[nodiscard]] Rotation inverse() const;
  [[nodiscard]] hal::Vec3 operator*(hal::Vec3 v) const;
  [[nodiscard]] Rotation operator*(const Rotation& inner) const;
};

// Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] Rotation rotation_of(const hal::Pose& pose);

// Yaw, pitch and roll of a rotation in (-pi, pi], [-pi/2, pi/2], (-pi, pi]. Looking straight up or down,
// where only their sum or difference is defined, roll is 0.
[[nodiscard]] hal::Pose pose_from(hal::Vec3 position, const Rotation& rotation);

// The body in the world, from the camera in the world and the camera on the body (its mounting).
[[nodiscard]] hal::Pose take_out_mount(const hal::Pose& camera_in_world, const hal::Pose& camera_on_body);

}  // namespace forager::flight
