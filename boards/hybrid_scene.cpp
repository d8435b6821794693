#include "boards/hybrid_scene.hpp"

#include <utility>

#include "boards/config_reader.hpp"
#include "hal/units.hpp"

namespace forager::boards {
namespace {

constexpr Range kMargin{0.0, 5.0};

void read_hop(ConfigReader& table, HybridScene& scene) {
  flight::HopLimits& hop = scene.route.hop;
  hop.body_radius_m = table.number("body_radius_m", hop.body_radius_m, {0.05, 5.0});
  hop.side_margin_m = table.number("side_margin_m", hop.side_margin_m, kMargin);
  hop.takeoff_margin_m = table.number("takeoff_margin_m", hop.takeoff_margin_m, kMargin);
  hop.landing_margin_m = table.number("landing_margin_m", hop.landing_margin_m, kMargin);
  hop.height_margin_m = table.number("height_margin_m", hop.height_margin_m, {0.1, 5.0});
  hop.most_climb_m = table.number("most_climb_m", hop.most_climb_m, {0.5, 10.0});
  hop.most_length_m = table.number("most_length_m", hop.most_length_m, {1.0, 100.0});
  hop.ceiling_m = table.number("ceiling_m", hop.ceiling_m, {1.0, 1000.0});
  scene.route.least_saving = table.number("least_saving", scene.route.least_saving, {0.0, 1.0});
  scene.flight_m_s = table.number("flight_m_s", scene.flight_m_s, {0.1, 1.0});
}

void read_area(ConfigReader& table, flight::GroundArea& area) {
  const auto low = table.numbers("area_min", 2);
  const auto high = table.numbers("area_max", 2);
  if (low.empty() != high.empty())
    table.complain("area_min", "and area_max go together", "Give both, or neither for open ground.");
  if (low.empty() || high.empty()) return;
  if (low[0] >= high[0] || low[1] >= high[1])
    table.complain("area_max", "is not beyond area_min", "Give the corner with the larger x and y.");
  area = {low[0], low[1], high[0], high[1]};
}

void read_energy(ConfigReader table, HybridScene& scene) {
  flight::EnergyAssumptions& a = scene.energy;
  a.mass_kg = table.number("mass_kg", a.mass_kg, {0.1, 100.0});
  a.rotors = static_cast<int>(table.integer("rotors", a.rotors, {1, 16}));
  a.rotor_radius_m = table.number("rotor_radius_m", a.rotor_radius_m, {0.02, 2.0});
  a.figure_of_merit = table.number("figure_of_merit", a.figure_of_merit, {0.1, 1.0});
  a.drive_efficiency = table.number("drive_efficiency", a.drive_efficiency, {0.1, 1.0});
  a.electronics_w = table.number("electronics_w", a.electronics_w, {0.0, 1000.0});
  a.rolling_resistance = table.number("rolling_resistance", a.rolling_resistance, {0.0, 0.3});
  a.rolling_thrust_n = table.number("rolling_thrust_n", a.rolling_thrust_n, {0.1, 1000.0});
  a.rolling_speed_m_s = table.number("rolling_speed_m_s", a.rolling_speed_m_s, {0.01, 3.0});
  a.turn_rate_rad_s = table.number("turn_rate_rad_s", a.turn_rate_rad_s, {0.01, 3.0});
  a.stop_s = table.number("stop_s", a.stop_s, {0.0, 60.0});
  a.climb_m_s = table.number("climb_m_s", a.climb_m_s, {0.05, 3.0});
  a.descent_m_s = table.number("descent_m_s", a.descent_m_s, {0.05, 3.0});
  a.flight_m_s = scene.flight_m_s;
  a.settle_s = table.number("settle_s", a.settle_s, {0.0, 60.0});
  a.arming_s = table.number("arming_s", a.arming_s, {0.0, 60.0});
}

void read_places(ConfigReader table, HybridScene& scene) {
  for (const auto& point : table.points("path", 2)) scene.places.push_back({point[0], point[1], 0.0});
}

// The heights only; the boxes themselves are read with the drive.
std::vector<std::optional<double>> read_heights(ConfigReader& top) {
  std::vector<std::optional<double>> heights;
  for (ConfigReader& table : top.tables("obstacles"))
    heights.push_back(table.optional_number("height_m", {0.01, 100.0}));
  return heights;
}

}  // namespace

bool is_hybrid_scene(const std::string& path) {
  const auto root = load_config(path);
  return root && root->find("hybrid") != nullptr;
}

hal::Result<HybridScene> read_hybrid_scene(const ConfigNode& root, const std::string& file) {
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  HybridScene scene;
  ConfigReader hybrid = top.table("hybrid");
  read_hop(hybrid, scene);
  read_area(hybrid, scene.route.area);
  read_energy(top.table("energy"), scene);
  read_places(top.table("drive"), scene);
  const auto heights = read_heights(top);
  // What was asked for here is known there.
  auto drive = read_drive_scene(root, file);
  if (issue) return hal::fail(std::move(*issue));
  if (!drive) return hal::fail(std::move(drive).error());
  scene.drive = *std::move(drive);
  scene.energy.rolling_pitch_rad = scene.drive.drive.steer.pitch_rad;
  if (auto valid = validate(scene.energy); !valid) {
    valid.error().device = "scene " + file;
    return hal::fail(std::move(valid).error());
  }
  for (std::size_t i = 0; i < scene.drive.obstacles.size(); ++i) {
    const DriveObstacle& o = scene.drive.obstacles[i];
    scene.obstacles.push_back({{0.5 * (o.min_x + o.max_x), 0.5 * (o.min_y + o.max_y), 0.0},
                               0.5 * (o.max_x - o.min_x),
                               0.5 * (o.max_y - o.min_y),
                               0.0,
                               heights[i]});
  }
  return scene;
}

hal::Result<HybridScene> load_hybrid_scene(const std::string& path) {
  auto root = load_config(path);
  if (!root) return hal::fail(std::move(root).error());
  return read_hybrid_scene(*root, path);
}

}  // namespace forager::boards
