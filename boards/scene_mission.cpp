#include "boards/scene_sections.hpp"
#include "hal/units.hpp"

namespace forager::boards {

using hal::deg_to_rad;

reader::ReadPlan read_read_plan(ConfigReader table) {
  using namespace std::chrono_literals;
  reader::ReadPlan plan;
  table.require("session", "the Gen2 session, session = \"S0\"");
  plan.session =
      reader::session_from(table.choice("session", "S0", {"S0", "S1", "S2", "S3"})).value_or(plan.session);
  plan.target =
      reader::target_from(table.choice("target", "A", {"A", "B", "AB", "BA"})).value_or(plan.target);
  if (table.has("q")) plan.q = static_cast<int>(table.integer("q", 4, {1, 15}));
  plan.power_dbm = table.number("power_dbm", plan.power_dbm, {0.0, 31.5});
  plan.sensitivity_dbm = table.number("sensitivity_dbm", plan.sensitivity_dbm, {-90.0, -20.0});
  plan.on_time = table.duration("on_time_ms", 600ms, {50.0, 3000.0});
  plan.off_time = table.duration("off_time_ms", 0ms, {0.0, 200.0});
  table.require("port", "at least one antenna port with its bearing");
  for (ConfigReader& entry : table.tables("port")) {
    reader::ReadPort port;
    entry.require("port", "the reader's port number, from 1");
    entry.require("bearing_deg", "where the antenna looks, in degrees to the left of the nose");
    port.port = static_cast<std::uint8_t>(entry.integer("port", 1, {1, 32}));
    port.name = entry.text("name", "port" + std::to_string(port.port));
    port.bearing_rad = hal::wrap_pi(deg_to_rad(entry.number("bearing_deg", 0.0, {-360.0, 360.0})));
    port.power_dbm = entry.optional_number("power_dbm", {0.0, 31.5});
    port.sensitivity_dbm = entry.optional_number("sensitivity_dbm", {-90.0, -20.0});
    plan.ports.push_back(std::move(port));
  }
  return plan;
}

SceneMission read_mission(ConfigReader table, const SceneVehicle& vehicle) {
  using namespace std::chrono_literals;
  SceneMission m;
  table.require("policy", "what decides where to go, policy = \"stigmergy\"");
  m.policy =
      policy_from(table.choice("policy", "stigmergy",
                               {"stigmergy", "static", "dead_reckoning", "stop_and_rotate", "random_walk"}))
          .value_or(m.policy);
  m.window = table.duration("window_s", 2s, {0.1, 60.0});
  m.settle = table.duration("settle_s", 200ms, {0.0, 10.0});
  m.step_m = table.number("step_m", m.step_m, {0.1, 5.0});
  m.speed_m_s = table.number("speed_m_s", m.speed_m_s, {0.05, vehicle.max_speed_m_s});
  m.arrival_m = table.number("arrival_m", m.arrival_m, {0.02, 1.0});
  m.arrival_yaw_rad = deg_to_rad(table.number("arrival_yaw_deg", 15.0, {1.0, 45.0}));
  m.tries = static_cast<int>(table.integer("tries", m.tries, {1, 1000}));
  if (table.has("time_limit_s")) m.time_limit = table.duration("time_limit_s", 0s, {1.0, 36000.0});
  m.battery_reserve = table.number("battery_reserve", m.battery_reserve, {0.0, 0.95});
  m.share = table.choice("share", "first_heard", {"first_heard", "split"}) == "split"
                ? reader::ShareRule::split
                : reader::ShareRule::first_heard;
  m.significance = table.number("significance", m.significance, {0.0, 10.0});
  m.winner_takes_all = table.flag("winner_takes_all", m.winner_takes_all);
  m.memory = table.flag("memory", m.memory);
  m.memory_half_life_s = table.number("memory_half_life_s", m.memory_half_life_s, {1.0, 3600.0});
  for (const auto& point : table.points("waypoints", 2))
    m.waypoints.push_back({point[0], point[1], vehicle.altitude_m});
  m.rotate_above = static_cast<std::uint32_t>(table.integer("rotate_above", m.rotate_above, {1, 10000}));
  m.rotate_below = static_cast<std::uint32_t>(table.integer("rotate_below", m.rotate_below, {0, 10000}));
  if (m.policy == PolicyKind::dead_reckoning)
    table.require("waypoints", "the path, waypoints = [[15.0, 0.0]]");
  if (m.policy == PolicyKind::hover || m.policy == PolicyKind::random_walk)
    table.require("time_limit_s", "how long this policy may go on");
  if (m.rotate_below > m.rotate_above)
    table.complain("rotate_below", "is above rotate_above", "A rotation must end below where it starts.");
  return m;
}

}  // namespace forager::boards
