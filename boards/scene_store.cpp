#include "boards/scene_sections.hpp"
#include "hal/units.hpp"

namespace forager::boards {

SceneStore read_store(ConfigReader table) {
  SceneStore store;
  if (!table.present()) return store;
  table.require("kind", "the shape of the store, kind = \"aisles\"");
  store.kind = table.choice("kind", "aisles", {"aisles", "t", "square", "halls", "random"});
  store.tags = static_cast<std::uint32_t>(table.integer("tags", store.tags, {1, 1e7}));
  store.tags_per_m2 = table.number("tags_per_m2", store.tags_per_m2, {0.01, 10000.0});
  store.aisle_m = table.number("aisle_m", store.aisle_m, {0.5, 20.0});
  store.shelf_depth_m = table.number("shelf_depth_m", store.shelf_depth_m, {0.1, 5.0});
  store.shelf_height_m = table.number("shelf_height_m", store.shelf_height_m, {0.3, 20.0});
  return store;
}

SceneSkip read_skip(ConfigReader table) {
  SceneSkip skip;
  skip.hazard_cut = table.number("hazard_cut", skip.hazard_cut, {0.0, 1.0});
  skip.grid = table.flag("grid", skip.grid);
  skip.behind = table.flag("behind", skip.behind);
  skip.blind_antennas = table.flag("blind_antennas", skip.blind_antennas);
  skip.silent = table.flag("silent", skip.silent);
  skip.unchanged_m = table.number("unchanged_m", skip.unchanged_m, {0.0, 0.1});
  skip.unchanged_rad = hal::deg_to_rad(table.number("unchanged_deg", 0.3, {0.0, 5.0}));
  return skip;
}

}  // namespace forager::boards
