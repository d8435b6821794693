#include "boards/drive_scene.hpp"

#include <fmt/format.h>

#include <cmath>

#include "boards/config_reader.hpp"
#include "boards/drive_path.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

using hal::deg_to_rad;

constexpr double kPathSpacing = 0.025;  // m, thesis sec. 6.6.2: what the planner delivers

constexpr double kLongestWay_m = 1000.0;

struct RangeKey {
  std::string_view name;
  DriveSpan fallback;
  Range allowed;
};
// In the order of DriveRange.
constexpr std::array<RangeKey, kDriveRanges> kRanges{{
    {"mass_kg", {3.5, 3.5}, {0.5, 50.0}},
    {"max_thrust_n", {50.0, 50.0}, {1.0, 1000.0}},
    {"friction", {0.6, 0.6}, {0.02, 2.0}},
    {"rolling_resistance", {0.025, 0.025}, {0.0, 0.3}},
    {"surface_drag_n_s_m", {0.3, 0.3}, {0.0, 50.0}},
    {"drag_asymmetry", {0.0, 0.0}, {-1.0, 1.0}},
    {"thrust_offset_m", {0.0, 0.0}, {-0.2, 0.2}},
    {"grade_x", {0.0, 0.0}, {-0.2, 0.2}},
    {"grade_y", {0.0, 0.0}, {-0.2, 0.2}},
    {"brake_force_n", {9.0, 9.0}, {0.5, 200.0}},
    {"servo_lag_s", {0.06, 0.06}, {0.001, 1.0}},
    {"thrust_lag_s", {0.1, 0.1}, {0.001, 1.0}},
    {"pose_noise_m", {0.004, 0.004}, {0.0, 0.2}},
    {"pose_noise_deg", {0.2, 0.2}, {0.0, 10.0}},
    {"dropouts_per_s", {0.0, 0.0}, {0.0, 5.0}},
    {"dropout_s", {0.3, 0.3}, {0.01, 5.0}},
    {"gyro_noise_deg_s", {0.5, 0.5}, {0.0, 20.0}},
    {"gyro_bias_deg_s", {0.0, 0.0}, {-5.0, 5.0}},
}};

void read_ranges(ConfigReader table, DriveScene& scene) {
  for (std::size_t i = 0; i < kDriveRanges; ++i) {
    const RangeKey& key = kRanges[i];
    scene.ranges[i] = key.fallback;
    const auto span = table.numbers(key.name, 2);
    if (span.empty()) continue;
    if (span[0] > span[1] || span[0] < key.allowed.min || span[1] > key.allowed.max)
      table.complain(key.name, fmt::format("is [{}, {}]", span[0], span[1]),
                     fmt::format("Give [low, high] within {} to {}.", key.allowed.min, key.allowed.max));
    scene.ranges[i] = {span[0], span[1]};
  }
}

void read_way(ConfigReader& table, DriveScene& scene) {
  const auto start = table.numbers("start_xy", 2);
  if (!start.empty()) scene.start.position = {start[0], start[1], 0.0};
  scene.start.yaw_rad = hal::wrap_pi(deg_to_rad(table.number("start_heading_deg", 0.0, {-360.0, 360.0})));
  table.require("path", "the corners of the way, such as path = [[0.0, 0.0], [3.0, 0.0]]");
  std::vector<DrivePoint> corners;
  for (const auto& point : table.points("path", 2)) corners.push_back({point[0], point[1]});
  const double corner_m = table.number("corner_m", 0.5, {0.0, 10.0});
  const bool moves = corners.size() > 1 && std::hypot(corners.back().x - corners.front().x,
                                                      corners.back().y - corners.front().y) > 0.2;
  if (!moves) {
    table.complain("path", "does not lead anywhere", "Give at least two corners, 0.2 m apart.");
    return;
  }
  double length = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    length += std::hypot(corners[i].x - corners[i - 1].x, corners[i].y - corners[i - 1].y);
  if (!(length <= kLongestWay_m)) {
    table.complain("path", fmt::format("is {:.0f} m long", length),
                   fmt::format("Give a way of at most {:.0f} m.", kLongestWay_m));
    return;
  }
  scene.path = rounded_path(corners, corner_m, kPathSpacing);
  scene.goal_heading_rad = hal::wrap_pi(deg_to_rad(
      table.number("goal_heading_deg", hal::rad_to_deg(scene.path.back().yaw_rad), {-360.0, 360.0})));
  scene.corridor_half_width_m =
      table.number("corridor_half_width_m", scene.corridor_half_width_m, {0.1, 10.0});
  scene.body_half_width_m = table.number("body_half_width_m", scene.body_half_width_m, {0.05, 5.0});
  scene.time_limit_s = table.number("time_limit_s", scene.time_limit_s, {1.0, 3600.0});
}

void read_steps(ConfigReader table, DriveScene& scene) {
  servo::StepConfig& s = scene.steps;
  s.min_step_m = table.number("min_m", s.min_step_m, {0.05, 10.0});
  s.max_step_m = table.number("max_m", s.max_step_m, {0.1, 20.0});
  s.tolerance_m = table.number("tolerance_m", s.tolerance_m, {0.001, 10.0});
  s.goal_margin_m = table.number("goal_margin_m", s.goal_margin_m, {0.01, 5.0});
  s.heading_margin_rad = deg_to_rad(table.number("heading_margin_deg", 10.0, {0.5, 180.0}));
}

void read_control(ConfigReader table, DriveScene& scene) {
  servo::BrakeSteerConfig& c = scene.drive.steer;
  c.half_track_m = table.number("half_track_m", c.half_track_m, {0.05, 5.0});
  c.thrust = table.number("thrust", c.thrust, {0.01, 0.9});
  c.pitch_rad = deg_to_rad(table.number("pitch_deg", hal::rad_to_deg(c.pitch_rad), {1.0, 60.0}));
  c.speed_by_pitch = table.flag("speed_by_pitch", c.speed_by_pitch);
  c.max_speed_m_s = table.number("max_speed_m_s", c.max_speed_m_s, {0.1, 3.0});
  c.arrive_speed_m_s = table.number("arrive_speed_m_s", c.arrive_speed_m_s, {0.05, 2.0});
  c.max_yaw_rate_rad_s =
      deg_to_rad(table.number("max_yaw_rate_deg_s", hal::rad_to_deg(c.max_yaw_rate_rad_s), {5.0, 180.0}));
  c.dab_rad_s = deg_to_rad(table.number("touch_deg_s", hal::rad_to_deg(c.dab_rad_s), {0.0, 60.0}));
  c.goal_margin_m = scene.steps.goal_margin_m;
  c.heading_margin_rad = scene.steps.heading_margin_rad;
  scene.drive.brakes.watch.half_track_m = c.half_track_m;
  scene.keeper_s = table.number("keeper_s", scene.keeper_s, {0.02, 5.0});
  scene.guided_timeout_s = table.number("guided_timeout_s", scene.guided_timeout_s, {0.1, 5.0});
}

void read_obstacles(ConfigReader& top, DriveScene& scene) {
  for (ConfigReader& table : top.tables("obstacles")) {
    table.require("min", "a corner, such as min = [1.0, 0.5]");
    table.require("max", "the opposite corner");
    const auto low = table.numbers("min", 2);
    const auto high = table.numbers("max", 2);
    if (low.empty() || high.empty()) continue;
    if (low[0] >= high[0] || low[1] >= high[1])
      table.complain("max", "is not beyond min", "Give the corner with the larger x and y.");
    scene.obstacles.push_back({low[0], low[1], high[0], high[1]});
  }
}

}  // namespace

std::string_view to_string(DriveRange range) { return kRanges[static_cast<std::size_t>(range)].name; }

hal::Result<DriveScene> read_drive_scene(const ConfigNode& root, const std::string& file) {
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  DriveScene scene;
  scene.file = file;
  ConfigReader about = top.table("drive");
  about.require("name", "a short name, such as name = \"course\"");
  scene.name = about.text("name", "");
  scene.title = about.text("title", scene.name);
  read_way(about, scene);
  read_steps(top.table("steps"), scene);
  read_control(top.table("control"), scene);
  read_ranges(top.table("ranges"), scene);
  read_obstacles(top, scene);
  check_unused(root, issue);
  if (issue) return hal::fail(std::move(*issue));
  return scene;
}

hal::Result<DriveScene> load_drive_scene(const std::string& path) {
  auto root = load_config(path);
  if (!root) return hal::fail(std::move(root).error());
  return read_drive_scene(*root, path);
}

}  // namespace forager::boards
