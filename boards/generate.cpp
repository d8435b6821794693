#include "boards/generate.hpp"

#include "boards/world_builder.hpp"
#include "mocks/tag_file.hpp"

namespace forager::boards {

hal::Result<std::size_t> write_world_tags(const Scene& scene, std::uint64_t seed, const std::string& path) {
  const mocks::World world = build_world(scene, seed);
  FORAGER_TRY(mocks::write_tag_file(path, world.tags));
  return world.tags.size();
}

hal::Result<std::size_t> write_world_layout(const Scene& scene, std::uint64_t seed, const std::string& path) {
  const mocks::TagLayout layout = build_layout(scene, build_world(scene, seed), seed);
  FORAGER_TRY(mocks::write_tag_file(path, layout.tags));
  return layout.tags.size();
}

}  // namespace forager::boards
