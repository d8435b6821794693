#pragma once

#include "boards/scene.hpp"
#include "hal/error.hpp"

namespace forager::boards {

// Reads the tag file that a scene names, if it names one; its path is taken from the scene's folder on.
// Errors: those of mocks::read_tag_file.
[[nodiscard]] hal::Result<> load_tag_file(Scene& scene);

}  // namespace forager::boards
