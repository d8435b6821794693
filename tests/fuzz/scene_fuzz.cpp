// Any bytes given as a scene file end in a scene or in one error line, never in a crash; a scene that was
// accepted holds only finite numbers and at least one port.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto node = forager::boards::parse_config(text, "fuzz.toml");
  if (!node) return describe(node.error()).empty() ? std::abort(), 0 : 0;
  const auto scene = forager::boards::read_scene(*node, "fuzz.toml");
  if (!scene) return describe(scene.error()).empty() ? std::abort(), 0 : 0;
  if (scene->read_plan.ports.empty()) std::abort();
  for (const auto& port : scene->read_plan.ports)
    if (!std::isfinite(port.bearing_rad)) std::abort();
  if (!std::isfinite(scene->vehicle.altitude_m) || !std::isfinite(scene->mission.step_m)) std::abort();
  for (const auto& group : scene->world.groups)
    for (const auto& centre : group.centres)
      if (!is_finite(centre)) std::abort();
  return 0;
}
