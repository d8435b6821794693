#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "boards/config_node.hpp"
#include "flight/drive_loop.hpp"
#include "hal/error.hpp"
#include "hal/pose.hpp"
#include "servo/path_steps.hpp"

namespace forager::boards {

// What differs from run to run, each drawn evenly from [low, high] by the run's seed. Names and units are the
// keys of [ranges].
enum class DriveRange : std::uint8_t {
  mass_kg,
  max_thrust_n,
  friction,
  rolling_resistance,
  surface_drag_n_s_m,
  drag_asymmetry,
  thrust_offset_m,
  grade_x,
  grade_y,
  brake_force_n,
  servo_lag_s,
  thrust_lag_s,
  pose_noise_m,
  pose_noise_deg,
  dropouts_per_s,
  dropout_s,
  gyro_noise_deg_s,
  gyro_bias_deg_s,
};
inline constexpr std::size_t kDriveRanges = 18;
[[nodiscard]] std::string_view to_string(DriveRange range);

struct DriveSpan {
  double low = 0.0;
  double high = 0.0;
};

struct DriveObstacle {
  double min_x = 0.0;
  double min_y = 0.0;
  double max_x = 0.0;
  double max_y = 0.0;
};

// A drive on wheels: a way from a start to a goal past obstacles, the corridor it may use, the controller's
// settings, and the ranges of everything nobody knows beforehand.
struct DriveScene {
  std::string file;
  std::string name;
  std::string title;
  hal::Pose start;
  std::vector<servo::PathPose> path;  // every 2.5 cm, corners rounded
  double goal_heading_rad = 0.0;
  double corridor_half_width_m = 0.45;
  double body_half_width_m = 0.55;  // wheels included; for contacts with obstacles
  double time_limit_s = 300.0;
  servo::StepConfig steps;
  flight::DriveConfig drive;
  std::array<DriveSpan, kDriveRanges> ranges{};
  std::vector<DriveObstacle> obstacles;
  double keeper_s = 0.2;          // brakes lock by themselves when nobody commands for so long
  double guided_timeout_s = 0.3;  // the autopilot levels the body when no setpoint comes for so long

  [[nodiscard]] const DriveSpan& range(DriveRange r) const { return ranges[static_cast<std::size_t>(r)]; }
};

// Reads a scene for `forager drive`. Errors: those of load_config; invalid_argument names file, line, key,
// value and what is allowed.
[[nodiscard]] hal::Result<DriveScene> load_drive_scene(const std::string& path);
[[nodiscard]] hal::Result<DriveScene> read_drive_scene(const ConfigNode& root, const std::string& file);

}  // namespace forager::boards
