#include "boards/policies.hpp"

#include "flight/baseline_dead_reckoning.hpp"
#include "flight/baseline_random_walk.hpp"
#include "flight/baseline_static.hpp"
#include "flight/baseline_stop_and_rotate.hpp"
#include "flight/stigmergy.hpp"

namespace forager::boards {
namespace {

flight::StigmergyConfig stigmergy_config(const Scene& scene) {
  const SceneMission& mission = scene.mission;
  flight::StigmergyConfig config;
  config.window = mission.window;
  config.step_m = mission.step_m;
  config.tries = static_cast<std::uint32_t>(mission.tries);
  config.heights_m = scene.vehicle.altitudes_m;
  if (config.heights_m.empty()) config.heights_m = {scene.vehicle.altitude_m};
  config.significance = mission.significance;
  config.winner_takes_all = mission.winner_takes_all;
  config.memory = mission.memory;
  config.memory_half_life_s = mission.memory_half_life_s;
  return config;
}

flight::StopAndRotateConfig stop_and_rotate_config(const Scene& scene) {
  flight::StopAndRotateConfig config;
  config.rotate_above = scene.mission.rotate_above;
  config.rotate_below = scene.mission.rotate_below;
  config.tries = static_cast<std::uint32_t>(scene.mission.tries);
  config.height_m = scene.vehicle.altitude_m;
  return config;
}

}  // namespace

std::unique_ptr<flight::Policy> make_policy(const Scene& scene, std::uint64_t seed) {
  const SceneMission& mission = scene.mission;
  const double height = scene.vehicle.altitude_m;
  const hal::Duration limit = mission.time_limit.value_or(hal::Duration::max());
  switch (mission.policy) {
    case PolicyKind::stigmergy:
      return std::make_unique<flight::Stigmergy>(stigmergy_config(scene));
    case PolicyKind::hover:
      return std::make_unique<flight::Static>(
          flight::StaticConfig{.mission_time = limit, .window = mission.window, .height_m = height});
    case PolicyKind::dead_reckoning: {
      flight::DeadReckoningConfig config;
      config.waypoints_world = mission.waypoints;
      config.height_m = height;
      config.speed_m_s = mission.speed_m_s;
      return std::make_unique<flight::DeadReckoning>(std::move(config));
    }
    case PolicyKind::stop_and_rotate:
      return std::make_unique<flight::StopAndRotate>(stop_and_rotate_config(scene));
    case PolicyKind::random_walk:
      return std::make_unique<flight::RandomWalk>(flight::RandomWalkConfig{.seed = seed,
                                                                           .window = mission.window,
                                                                           .step_m = mission.step_m,
                                                                           .height_m = height,
                                                                           .mission_time = limit});
  }
  return nullptr;
}

}  // namespace forager::boards
