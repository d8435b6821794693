#include "boards/world_builder.hpp"

#include <string_view>

#include "hal/random.hpp"
#include "mocks/store_plan.hpp"
#include "mocks/warehouse.hpp"

namespace forager::boards {

std::uint64_t seed_for(std::uint64_t seed, SeedStream stream) {
  return hal::Random::stream(seed, static_cast<std::uint64_t>(stream)).next();
}

namespace {

mocks::StoreKind store_kind(std::string_view name) {
  if (name == "t") return mocks::StoreKind::t;
  if (name == "square") return mocks::StoreKind::square;
  if (name == "halls") return mocks::StoreKind::halls;
  return name == "random" ? mocks::StoreKind::random : mocks::StoreKind::aisles;
}

mocks::StorePlan store_plan(const SceneStore& store) {
  mocks::StorePlan plan;
  plan.kind = store_kind(store.kind);
  plan.tags = store.tags;
  plan.tags_per_m2 = store.tags_per_m2;
  plan.aisle_m = store.aisle_m;
  plan.shelf_depth_m = store.shelf_depth_m;
  plan.shelf_height_m = store.shelf_height_m;
  return plan;
}

}  // namespace

mocks::World build_world(const Scene& scene, std::uint64_t seed) {
  mocks::World world;
  for (const SceneShelf& shelf : scene.world.shelves) world.obstacles.push_back({shelf.min, shelf.max});
  hal::Random random(seed_for(seed, SeedStream::tags));
  constexpr std::uint32_t kCompany = 0x9BB600;
  constexpr std::uint32_t kStoreItem = 0x80000;  // beyond what groups count up to
  std::uint32_t item = 1;
  for (const SceneGroup& group : scene.world.groups) {
    mocks::EpcSequence epcs(kCompany, item++);
    for (const hal::Vec3& centre : group.centres) {
      mocks::BoxGroup box;
      box.centre = centre;
      box.tags = static_cast<int>(group.tags);
      box.half_width_m = group.spread_xy_m;
      box.height_m = group.spread_z_m;
      box.wanted = group.wanted;
      add_group(world, box, epcs, random);
    }
  }
  if (!scene.world.store.kind.empty()) {
    mocks::EpcSequence epcs(kCompany, kStoreItem);
    // What the scene reader let through makes a store.
    static_cast<void>(add_store(world, store_plan(scene.world.store), epcs, random));
  }
  if (scene.world.file_tags != nullptr) append(world.tags, *scene.world.file_tags);
  return world;
}

mocks::TagLayout build_layout(const Scene& scene, const mocks::World& world, std::uint64_t seed) {
  hal::Random random(seed_for(seed, SeedStream::layout));
  return layout_of(world.tags, {scene.world.mislabeled, scene.world.unlisted}, random);
}

WorldFacts facts_of(const Scene& scene, const mocks::World& world, std::uint64_t seed) {
  WorldFacts facts;
  for (const mocks::Box& box : world.obstacles) facts.shelves.push_back({box.min, box.max});
  facts.tags = WorldTags(world.tags);
  if (scene.world.mislabeled + scene.world.unlisted > 0.0)
    facts.layout = std::make_shared<const mocks::TagList>(build_layout(scene, world, seed).tags);
  return facts;
}

mocks::SimDepthOptions depth_options(const Scene& scene) {
  mocks::SimDepthOptions options;
  options.columns = scene.camera.columns;
  options.rows = scene.camera.rows;
  options.hfov_rad = scene.camera.horizontal_fov_rad;
  options.vfov_rad = scene.camera.vertical_fov_rad;
  options.min_m = scene.camera.min_m;
  options.max_m = scene.camera.max_m;
  options.period = hal::from_seconds(1.0 / scene.camera.rate_hz);
  options.noise_per_m = scene.camera.noise;
  options.far_as_max = true;  // an open hall is free, not unseen
  return options;
}

mocks::SimPoseOptions pose_options(const Scene& scene) {
  mocks::SimPoseOptions options;
  options.period = hal::from_seconds(1.0 / scene.localisation.rate_hz);
  options.position_noise_m = scene.localisation.noise_m;
  options.angle_noise_rad = scene.localisation.noise_rad;
  return options;
}

mocks::SimAutopilotConfig autopilot_config(const Scene& scene, std::uint64_t seed) {
  mocks::SimAutopilotConfig config;
  config.start = scene.vehicle.start;
  config.vehicle.max_speed_m_s = scene.vehicle.max_speed_m_s;
  config.vehicle.max_acceleration_m_s2 = scene.vehicle.max_acceleration_m_s2;
  config.vehicle.max_climb_m_s = scene.vehicle.max_climb_m_s;
  config.vehicle.max_descent_m_s = scene.vehicle.max_climb_m_s;
  config.vehicle.max_yaw_rate_rad_s = scene.vehicle.max_yaw_rate_rad_s;
  config.vehicle.radius_m = scene.vehicle.body_radius_m;
  config.vehicle.endurance_s = scene.vehicle.battery_s;
  config.seed = seed_for(seed, SeedStream::autopilot);
  return config;
}

}  // namespace forager::boards
