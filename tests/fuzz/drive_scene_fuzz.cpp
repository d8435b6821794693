// Any text as a drive scene: an error or a scene whose path and steps can be made, never a crash.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/drive_run.hpp"
#include "boards/drive_scene.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace forager;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto root = boards::parse_config(text, "fuzz.toml");
  if (!root) return 0;
  const auto scene = boards::read_drive_scene(*root, "fuzz.toml");
  if (!scene) return 0;
  for (const servo::PathPose& pose : scene->path)
    if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m)) std::abort();
  // Long ways only cost time.
  if (scene->path.size() < 2000) static_cast<void>(boards::drive_mission(*scene));
  return 0;
}
