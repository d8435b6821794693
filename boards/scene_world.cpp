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
  read_pattern(table, r);
  r.pattern_exponent = table.number("pattern_exponent", r.pattern_exponent, {0.1, 4.0});
  r.spread_db = table.number("spread_db", r.spread_db, {0.0, 20.0});
  r.power_up_limit = table.number("power_up_limit", r.power_up_limit, {0.1, 100.0});
  r.rician_k_db = table.number("rician_k_db", r.rician_k_db, {-20.0, 100.0});
  r.rssi_at_1m_dbm = table.number("rssi_at_1m_dbm", r.rssi_at_1m_dbm, {-90.0, 0.0});
  r.patience_s = table.number("patience_s", r.patience_s, {0.001, 60.0});
  r.singulation_s = table.optional_number("singulation_s", {0.0, 1.0});
  r.tag_axes = table.choice("tag_axes", r.tag_axes, {"none", "upright", "scattered"});
  r.polarisation_loss_db = table.number("polarisation_loss_db", r.polarisation_loss_db, {0.0, 60.0});
  r.occlusion_db = table.number("occlusion_db", r.occlusion_db, {0.0, 60.0});
  return r;
}

SceneAir read_air(ConfigReader table) {
  SceneAir a;
  a.model = table.choice("model", "round", {"round", "slot"}) == "slot" ? AirModel::slot : AirModel::round;
  a.tari_us = table.number("tari_us", a.tari_us, {6.25, 25.0});
  a.pie = table.number("pie", a.pie, {1.5, 2.0});
  a.blf_khz = table.number("blf_khz", a.blf_khz, {40.0, 640.0});
  const std::string encoding = table.choice("encoding", "M4", {"FM0", "M2", "M4", "M8"});
  a.m = encoding == "FM0" ? 1 : encoding.back() - '0';
  a.pilot_tone = table.flag("pilot_tone", a.pilot_tone);
  a.first_q = table.number("first_q", a.first_q, {0.0, 15.0});
  a.q_step = table.number("q_step", a.q_step, {0.05, 1.0});
  a.round_overhead_s = 1e-3 * table.number("round_overhead_ms", 1e3 * a.round_overhead_s, {0.0, 1000.0});
  a.dwell_s = table.optional_number("dwell_s", {0.02, 60.0});
  a.hop_interval_s = table.number("hop_interval_s", a.hop_interval_s, {0.0, 1000.0});
  a.capture_probability = table.number("capture_probability", a.capture_probability, {0.0, 1.0});
  return a;
}

}  // namespace

SceneWorld read_world(ConfigReader table) {
  SceneWorld world;
  for (ConfigReader& shelf : table.tables("shelves")) world.shelves.push_back(read_shelf(shelf));
  for (ConfigReader& group : table.tables("groups")) world.groups.push_back(read_group(group));
  world.store = read_store(table.table("generate"));
  world.tag_file = table.text("tag_file", "");
  world.mislabeled = table.number("mislabeled", world.mislabeled, {0.0, 1.0});
  world.unlisted = table.number("unlisted", world.unlisted, {0.0, 1.0});
  if (world.mislabeled + world.unlisted > 1.0)
    table.complain("unlisted", "and mislabeled are more than all tags", "Shares: together at most 1.");
  world.radio = read_radio(table.table("radio"));
  world.air = read_air(table.table("air"));
  world.skip = read_skip(table.table("skip"));
  return world;
}

}  // namespace forager::boards
