#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "boards/scene.hpp"
#include "hal/error.hpp"

namespace forager::boards {

// Writes every tag of a scene's world, as the seed places it, into a tag file (docs/boards.md). Gives the
// number of tags. Errors: not_present (no such folder), permission, io.
[[nodiscard]] hal::Result<std::size_t> write_world_tags(const Scene& scene, std::uint64_t seed,
                                                        const std::string& path);

// The list that the scene keeps of them instead, with its mislabeled and unlisted tags. Errors: the same.
[[nodiscard]] hal::Result<std::size_t> write_world_layout(const Scene& scene, std::uint64_t seed,
                                                          const std::string& path);

}  // namespace forager::boards
