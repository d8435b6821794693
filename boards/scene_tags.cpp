#include "boards/scene_tags.hpp"

#include <filesystem>
#include <utility>

#include "mocks/tag_file.hpp"

namespace forager::boards {

hal::Result<> load_tag_file(Scene& scene) {
  if (scene.world.tag_file.empty()) return {};
  const auto path = std::filesystem::path(scene.file).parent_path() / scene.world.tag_file;
  auto tags = std::make_shared<mocks::TagList>();
  FORAGER_TRY(mocks::read_tag_file(path.string(), *tags));
  scene.world.file_tags = std::move(tags);
  return {};
}

}  // namespace forager::boards
