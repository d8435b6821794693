#pragma once

#include <cstdint>

#include "boards/drive_scene.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"

namespace forager::boards {

// What one seed draws from a scene's ranges.
struct DrivePlantDraw {
  mocks::RollingParameters vehicle;
  mocks::SimPoseOptions pose;
  double gyro_noise_rad_s = 0.0;
  double gyro_bias_rad_s = 0.0;
};
[[nodiscard]] DrivePlantDraw draw_plant(const DriveScene& scene, std::uint64_t seed);

// Stream numbers of a run's seed.
enum class DriveStream : std::uint64_t { plant = 0x64727665, pose, gyro, fault, autopilot };
[[nodiscard]] std::uint64_t drive_seed(std::uint64_t seed, DriveStream stream);

}  // namespace forager::boards
