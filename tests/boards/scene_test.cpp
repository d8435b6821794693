#include "boards/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "hal/units.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

const std::string kScenes = test::source_path("scenes/");

constexpr const char* kSmall = R"(
[scene]
name = "small"
[reader]
session = "S1"
port = [{ port = 4, bearing_deg = 0.0 }]
[mission]
policy = "stigmergy"
)";

hal::Result<Scene> scene_of(const std::string& text) {
  auto node = parse_config(text, "small.toml");
  if (!node) return hal::fail(node.error());
  return read_scene(*node, "small.toml");
}

std::string complaint(const std::string& text) {
  const auto scene = scene_of(text);
  return scene ? "accepted" : describe(scene.error());
}

TEST(SceneFile, EveryPublishedExperimentLoadsWithItsTagCount) {
  const std::map<std::string, std::pair<std::size_t, PolicyKind>> expected{
      {"1A", {330, PolicyKind::hover}},
      {"1B", {330, PolicyKind::dead_reckoning}},
      {"1C", {330, PolicyKind::stigmergy}},
      {"2A", {330, PolicyKind::hover}},
      {"2B", {330, PolicyKind::dead_reckoning}},
      {"2C", {330, PolicyKind::stigmergy}},
      {"3A", {660, PolicyKind::hover}},
      {"3B", {660, PolicyKind::dead_reckoning}},
      {"3C", {660, PolicyKind::stigmergy}},
      {"4A", {300, PolicyKind::stigmergy}},
      {"4B", {480, PolicyKind::stigmergy}},
      {"4C", {960, PolicyKind::stigmergy}},
      {"5A", {300, PolicyKind::stigmergy}},
      {"5B", {1700, PolicyKind::stigmergy}},
      {"ch4-1", {240, PolicyKind::dead_reckoning}},
      {"ch4-2", {600, PolicyKind::dead_reckoning}},
      {"ch4-3", {1200, PolicyKind::dead_reckoning}}};
  for (const auto& [name, what] : expected) {
    const auto scene = load_scene(kScenes + name + ".toml");
    ASSERT_TRUE(scene) << describe(scene.error());
    std::size_t tags = 0;
    for (const SceneGroup& group : scene->world.groups) tags += group.tags * group.centres.size();
    EXPECT_EQ(tags, what.first) << name;
    EXPECT_EQ(scene->mission.policy, what.second) << name;
    EXPECT_EQ(scene->name, name);
  }
}

TEST(SceneFile, AnglesBecomeRadiansAndPortsKeepTheirBearing) {
  const auto scene = load_scene(kScenes + "4A.toml");
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->read_plan.ports.size(), 4U);
  EXPECT_EQ(scene->read_plan.ports[0].port, 4);
  EXPECT_DOUBLE_EQ(scene->read_plan.ports[0].bearing_rad, 0.0);
  EXPECT_DOUBLE_EQ(scene->read_plan.ports[1].bearing_rad, hal::kPi / 2.0);
  EXPECT_DOUBLE_EQ(scene->read_plan.ports[3].bearing_rad, -hal::kPi / 2.0);
}

TEST(SceneFile, WrongInputIsOneLineWithWhatWhereAndWhatToDo) {
  const std::string base = kSmall;
  EXPECT_EQ(complaint(base), "accepted");
  EXPECT_THAT(complaint(base + "[misson]\n"),
              HasSubstr("small.toml:9: misson: is not a known key here. Did you mean 'mission'?"));
  EXPECT_THAT(complaint(base + "windows_s = 2\n"),
              HasSubstr("mission.windows_s: is not a known key here. Did you mean 'window_s'?"));
  EXPECT_THAT(complaint(base + "tries = 0\n"), HasSubstr("[mission] tries: is 0. Allowed: 1 to 1000."));
  EXPECT_THAT(complaint(base + "[vehicle]\naltitude_m = -1\n"),
              HasSubstr("[vehicle] altitude_m: is -1. Allowed: 0.3 to 30."));
  EXPECT_THAT(complaint("[scene]\nname=\"x\"\n[reader]\nsession=\"S0\"\nport=[{port=1}]\n[mission]\npolicy="
                        "\"stigmergy\"\n"),
              HasSubstr("bearing_deg: is missing. Give where the antenna looks"));
  EXPECT_THAT(complaint("[scene]\nname=\"x\"\n[reader]\nsession=\"S4\"\nport=[{port=1,bearing_deg=0}]\n["
                        "mission]\npolicy=\"stigmergy\"\n"),
              HasSubstr("session: is \"S4\". Allowed: S0, S1, S2, S3."));
  EXPECT_THAT(complaint("[scene]\nname=\"x\"\n[reader]\nsession=\"S0\"\nport=[{port=1,bearing_deg=0},{port=1,"
                        "bearing_deg=90}]\n[mission]\npolicy=\"stigmergy\"\n"),
              HasSubstr("small.toml"));
  EXPECT_THAT(complaint("[scene]\nname=\"x\"\n[reader]\nsession=\"S0\"\nport=[{port=1,bearing_deg=0}]\n["
                        "mission]\npolicy=\"dead_reckoning\"\n"),
              HasSubstr("[mission] waypoints: is missing"));
  EXPECT_THAT(complaint(base + "[[world.shelves]]\nmin=[0,0,0]\nmax=[1,0,1]\n"),
              HasSubstr("is not above min on every axis"));
}

}  // namespace
}  // namespace forager::boards
