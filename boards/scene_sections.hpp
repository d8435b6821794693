#pragma once

#include "boards/config_reader.hpp"
#include "boards/scene.hpp"

namespace forager::boards {

// One function per part of a scene file; each takes the reader of its own table.
[[nodiscard]] SceneVehicle read_vehicle(ConfigReader table);
[[nodiscard]] SceneCamera read_camera(ConfigReader table);
[[nodiscard]] SceneLocalisation read_localisation(ConfigReader table);
[[nodiscard]] reader::ReadPlan read_read_plan(ConfigReader table);
[[nodiscard]] flight::GuardConfig read_guard(ConfigReader table, const SceneVehicle& vehicle);
[[nodiscard]] SceneMission read_mission(ConfigReader table, const SceneVehicle& vehicle);
[[nodiscard]] SceneLinks read_links(ConfigReader table);
[[nodiscard]] SceneWorld read_world(ConfigReader table);
void read_pattern(ConfigReader& radio, SceneRadio& into);  // the pattern keys of [world.radio]
[[nodiscard]] SceneStore read_store(ConfigReader table);   // [world.generate]
[[nodiscard]] SceneSkip read_skip(ConfigReader table);     // [world.skip]

}  // namespace forager::boards
