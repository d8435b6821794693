#include "boards/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "boards/scene_sections.hpp"
#include "boards/scene_tags.hpp"

namespace forager::boards {
namespace {

constexpr std::array<std::pair<PolicyKind, std::string_view>, 5> kPolicies{{
    {PolicyKind::stigmergy, "stigmergy"},
    {PolicyKind::hover, "static"},
    {PolicyKind::dead_reckoning, "dead_reckoning"},
    {PolicyKind::stop_and_rotate, "stop_and_rotate"},
    {PolicyKind::random_walk, "random_walk"},
}};

// The name becomes part of a file name.
void read_name(ConfigReader& about, Scene& scene) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  about.require("name", "a short name, such as name = \"4A\"");
  scene.name = about.text("name", "");
  if (scene.name.empty() || scene.name.size() > 40 || scene.name.front() == '.' ||
      scene.name.find_first_not_of(kAllowed) != std::string::npos)
    about.complain("name", fmt::format("is \"{}\"", scene.name),
                   "Allowed: up to 40 letters, digits, '-', '_' and '.', not beginning with '.'.");
  scene.title = about.text("title", scene.name);
}

}  // namespace

std::string_view to_string(PolicyKind kind) {
  for (const auto& [value, name] : kPolicies)
    if (value == kind) return name;
  return "unknown";
}

hal::Result<PolicyKind> policy_from(std::string_view name) {
  std::vector<std::string_view> names;
  for (const auto& [value, text] : kPolicies) {
    if (text == name) return value;
    names.push_back(text);
  }
  return hal::fail(hal::ErrorCode::invalid_argument, "mission", "policy",
                   fmt::format("\"{}\" is not a policy", name),
                   fmt::format("Allowed: {}.", fmt::join(names, ", ")));
}

hal::Result<Scene> read_scene(const ConfigNode& root, const std::string& file) {
  ConfigIssue issue;
  ConfigReader top(&root, "", issue);
  Scene scene;
  scene.file = file;
  ConfigReader about = top.table("scene");
  read_name(about, scene);
  scene.vehicle = read_vehicle(top.table("vehicle"));
  scene.camera = read_camera(top.table("camera"));
  scene.localisation = read_localisation(top.table("localisation"));
  scene.read_plan = read_read_plan(top.table("reader"));
  scene.guard = read_guard(top.table("guard"), scene.vehicle);
  scene.mission = read_mission(top.table("mission"), scene.vehicle);
  scene.links = read_links(top.table("links"));
  scene.world = read_world(top.table("world"));
  check_unused(root, issue);
  if (issue) return hal::fail(std::move(*issue));
  if (auto valid = reader::validate(scene.read_plan); !valid) {
    hal::Error error = std::move(valid).error();
    error.device = file;
    return hal::fail(std::move(error));
  }
  return scene;
}

hal::Result<> change_policy(Scene& scene, PolicyKind policy) {
  scene.mission.policy = policy;
  const bool endless = policy == PolicyKind::hover || policy == PolicyKind::random_walk;
  if (endless && !scene.mission.time_limit)
    return hal::fail(hal::ErrorCode::invalid_argument, scene.file, "policy " + std::string(to_string(policy)),
                     "needs [mission] time_limit_s",
                     "Add it to the scene: this policy never ends by itself.");
  if (policy == PolicyKind::dead_reckoning && scene.mission.waypoints.empty())
    return hal::fail(hal::ErrorCode::invalid_argument, scene.file, "policy dead_reckoning",
                     "needs [mission] waypoints", "Add the path to the scene: waypoints = [[15.0, 0.0]].");
  return {};
}

hal::Result<Scene> load_scene(const std::string& path) {
  auto root = load_config(path);
  if (!root) return hal::fail(std::move(root).error());
  auto scene = read_scene(*root, path);
  if (scene) FORAGER_TRY(load_tag_file(*scene));
  return scene;
}

}  // namespace forager::boards
