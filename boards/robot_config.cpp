#include "boards/robot_config.hpp"

namespace forager::boards {

flight::RobotLoopConfig robot_config(const Scene& scene, std::size_t expected_tags) {
  const SceneMission& mission = scene.mission;
  flight::RobotLoopConfig config;
  config.ports = scene.read_plan.ports;
  config.share = mission.share;
  config.expected_tags = expected_tags + 64;
  config.takeoff_height_m = scene.vehicle.altitude_m;
  config.guard = scene.guard;
  config.settle = mission.settle;
  config.step.speed_m_s = mission.speed_m_s;
  config.step.arrival_m = mission.arrival_m;
  config.step.arrival_yaw_rad = mission.arrival_yaw_rad;
  config.step.braking_m_s2 = scene.guard.braking_m_s2;
  config.vision.min_interval = hal::from_seconds(1.0 / scene.localisation.rate_hz);
  config.vision.max_speed_m_s = 2.0 * scene.vehicle.max_speed_m_s;
  config.vision.max_yaw_rate_rad_s = 2.0 * scene.vehicle.max_yaw_rate_rad_s;
  config.vision.stale_after = scene.links.pose_timeout;
  config.limits.start_timeout = scene.links.start_timeout;
  config.limits.flight_time = mission.time_limit;
  config.limits.battery_reserve = mission.battery_reserve;
  config.limits.reader_allowance = scene.links.reader_allowance;
  config.limits.autopilot_allowance = scene.links.autopilot_allowance;
  config.limits.pose_allowance = scene.links.pose_allowance;
  config.limits.store_allowance = scene.links.store_allowance;
  return config;
}

flight::MavlinkConfig mavlink_config(const Scene& scene, bool journal_wire) {
  flight::MavlinkConfig config;
  config.deadman = scene.links.deadman;
  config.link_timeout = scene.links.autopilot_timeout;
  config.origin = flight::GlobalOrigin{41.4, 2.2, 0.0};  // indoors any will do
  config.journal_wire = journal_wire;
  return config;
}

reader::AdvanNetConfig advannet_config(const Scene& scene, const Board& board) {
  using namespace std::chrono_literals;
  reader::AdvanNetConfig config;
  config.device_id = board.reader_device_id;
  config.request_timeout = scene.links.reader_timeout;
  config.stream_timeout = scene.links.stream_timeout;
  config.status_period = 30s;
  config.backoff_first = 1s;
  config.backoff_cap = 60s;
  return config;
}

}  // namespace forager::boards
