#include "boards/scene_sections.hpp"
#include "hal/units.hpp"

namespace forager::boards {

using hal::deg_to_rad;

SceneVehicle read_vehicle(ConfigReader table) {
  SceneVehicle v;
  const auto start = table.numbers("start_xy", 2);
  if (!start.empty()) v.start.position = {start[0], start[1], 0.0};
  v.start.yaw_rad = deg_to_rad(table.number("start_heading_deg", 0.0, {-360.0, 360.0}));
  v.start.yaw_rad = hal::wrap_pi(v.start.yaw_rad);
  v.altitude_m = table.number("altitude_m", v.altitude_m, {0.3, 30.0});
  v.altitudes_m = table.number_list("altitudes_m", {0.3, 30.0});
  v.body_radius_m = table.number("body_radius_m", v.body_radius_m, {0.05, 3.0});
  v.max_speed_m_s = table.number("max_speed_m_s", v.max_speed_m_s, {0.05, 10.0});
  v.max_acceleration_m_s2 = table.number("max_acceleration_m_s2", v.max_acceleration_m_s2, {0.05, 10.0});
  v.max_climb_m_s = table.number("max_climb_m_s", v.max_climb_m_s, {0.05, 5.0});
  v.max_yaw_rate_rad_s = deg_to_rad(table.number("max_yaw_rate_deg_s", 60.0, {1.0, 360.0}));
  v.battery_s = table.number("battery_s", v.battery_s, {10.0, 36000.0});
  v.battery_start = table.number("battery_start", v.battery_start, {0.0, 1.0});
  return v;
}

SceneCamera read_camera(ConfigReader table) {
  SceneCamera c;
  c.columns = static_cast<int>(table.integer("columns", c.columns, {1, 1920}));
  c.rows = static_cast<int>(table.integer("rows", c.rows, {1, 1080}));
  c.horizontal_fov_rad = deg_to_rad(table.number("horizontal_fov_deg", 87.0, {5.0, 170.0}));
  c.vertical_fov_rad = deg_to_rad(table.number("vertical_fov_deg", 58.0, {5.0, 170.0}));
  c.rate_hz = table.number("rate_hz", c.rate_hz, {0.5, 120.0});
  c.min_m = table.number("min_m", c.min_m, {0.0, 5.0});
  c.max_m = table.number("max_m", c.max_m, {0.5, 60.0});
  c.noise = table.number("noise", c.noise, {0.0, 0.1});
  if (c.max_m <= c.min_m) table.complain("max_m", "is not above min_m", "Give the camera's working range.");
  return c;
}

SceneLocalisation read_localisation(ConfigReader table) {
  SceneLocalisation l;
  l.rate_hz = table.number("rate_hz", l.rate_hz, {4.0, 200.0});
  l.noise_m = table.number("noise_m", l.noise_m, {0.0, 1.0});
  l.noise_rad = deg_to_rad(table.number("noise_deg", 0.1, {0.0, 20.0}));
  return l;
}

flight::GuardConfig read_guard(ConfigReader table, const SceneVehicle& vehicle) {
  flight::GuardConfig g;
  g.half_width_m = vehicle.body_radius_m;
  g.side_margin_m = table.number("margin_m", g.side_margin_m, {0.0, 2.0});
  g.above_m = table.number("above_m", g.above_m, {0.05, 5.0});
  g.below_m = table.number("below_m", g.below_m, {0.05, 5.0});
  g.clear_distance_m = table.number("distance_m", g.clear_distance_m, {0.2, 20.0});
  g.braking_m_s2 = table.number("braking_m_s2", vehicle.max_acceleration_m_s2, {0.05, 20.0});
  g.latency_s = table.number("latency_s", g.latency_s, {0.0, 5.0});
  g.margin_m = table.number("stop_margin_m", g.margin_m, {0.0, 5.0});
  g.valid_share = table.number("min_valid_share", g.valid_share, {0.05, 1.0});
  g.nearest = static_cast<std::uint32_t>(table.integer("k_smallest", g.nearest, {1, 64}));
  g.max_age = table.duration("max_age_ms", g.max_age, {10.0, 5000.0});
  if (g.below_m >= vehicle.altitude_m)
    table.complain("below_m", "reaches the floor at the flown height",
                   "Make it smaller than vehicle.altitude_m.");
  return g;
}

SceneLinks read_links(ConfigReader table) {
  using namespace std::chrono_literals;
  SceneLinks l;
  l.reader_timeout = table.duration("reader_timeout_s", 5s, {0.1, 120.0});
  l.stream_timeout = table.duration("stream_timeout_s", 10s, {5.5, 120.0});
  l.reader_allowance = table.duration("reader_allowance_s", 60s, {1.0, 3600.0});
  l.autopilot_timeout = table.duration("autopilot_timeout_s", 4s, {1.5, 60.0});
  l.autopilot_allowance = table.duration("autopilot_allowance_s", 30s, {1.0, 3600.0});
  l.pose_allowance = table.duration("pose_allowance_s", 2s, {0.1, 60.0});
  l.store_allowance = table.duration("store_allowance_s", 15s, {0.1, 3600.0});
  l.pose_timeout = table.duration("pose_timeout_s", 500ms, {0.1, 10.0});
  l.start_timeout = table.duration("start_timeout_s", 60s, {1.0, 600.0});
  l.deadman = table.duration("deadman_s", 1s, {0.1, 10.0});
  return l;
}

}  // namespace forager::boards
