#include <cmath>

#include "boards/scene_sections.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

using hal::deg_to_rad;

constexpr std::uint64_t kMaxTags = 10'000'000;

hal::Vec3 to_vec(const std::vector<double>& numbers) {
  return numbers.size() == 3 ? hal::Vec3{numbers[0], numbers[1], numbers[2]} : hal::Vec3{};
}

SceneShelf read_shelf(ConfigReader& table) {
  SceneShelf shelf;
  table.require("min", "the lower corner, min = [x, y, z] in metres");
  table.require("max", "the upper corner, max = [x, y, z] in metres");
  shelf.min = to_vec(table.numbers("min", 3));
  shelf.max = to_vec(table.numbers("max", 3));
  if (shelf.max.x <= shelf.min.x || shelf.max.y <= shelf.min.y || shelf.max.z <= shelf.min.z)
    table.complain("max", "is not above min on every axis", "Swap the corners.");
  return shelf;
}

SceneGroup read_group(ConfigReader& table) {
  SceneGroup group;
  table.require("tags", "the number of tags in each box");
  table.require("centres", "where the boxes stand, centres = [[x, y, z], ...]");
  group.tags = static_cast<std::uint32_t>(table.integer("tags", 0, {1, 1e6}));
  group.spread_xy_m = table.number("spread_xy_m", group.spread_xy_m, {0.0, 10.0});
  group.spread_z_m = table.number("spread_z_m", group.spread_z_m, {0.0, 10.0});
  group.wanted = table.flag("wanted", group.wanted);
  for (const auto& centre : table.points("centres", 3)) group.centres.push_back(to_vec(centre));
  if (group.tags * group.centres.size() > kMaxTags)
    table.complain("tags", "makes more than ten million tags", "Make fewer.");
  return group;
}

SceneRadio read_radio(ConfigReader table) {
  SceneRadio r;
  r.r0_m = table.number("r0_m", r.r0_m, {0.05, 50.0});
  r.t0_s = table.number("t0_s", r.t0_s, {0.01, 100.0});
  r.beam_horizontal_rad = deg_to_rad(table.number("beam_horizontal_deg", 70.0, {5.0, 180.0}));
  r.beam_vertical_rad = deg_to_rad(table.number("beam_vertical_deg", 70.0, {5.0, 180.0}));
  r.pattern = table.choice("pattern", r.pattern, {"cosine", "gaussian"});
  r.pattern_exponent = table.number("pattern_exponent", r.pattern_exponent, {0.1, 4.0});
  r.spread_db = table.number("spread_db", r.spread_db, {0.0, 20.0});
  r.power_up_limit = table.number("power_up_limit", r.power_up_limit, {0.1, 100.0});
  r.rician_k_db = table.number("rician_k_db", r.rician_k_db, {-20.0, 100.0});
  r.rssi_at_1m_dbm = table.number("rssi_at_1m_dbm", r.rssi_at_1m_dbm, {-90.0, 0.0});
  r.patience_s = table.number("patience_s", r.patience_s, {0.001, 60.0});
  r.singulation_s = table.number("singulation_s", r.singulation_s, {0.0, 1.0});
  r.occlusion_db = table.number("occlusion_db", r.occlusion_db, {0.0, 60.0});
  return r;
}

}  // namespace

SceneWorld read_world(ConfigReader table) {
  SceneWorld world;
  for (ConfigReader& shelf : table.tables("shelves")) world.shelves.push_back(read_shelf(shelf));
  for (ConfigReader& group : table.tables("groups")) world.groups.push_back(read_group(group));
  world.radio = read_radio(table.table("radio"));
  return world;
}

}  // namespace forager::boards
