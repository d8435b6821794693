#pragma once

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "tools/cmd_reader.hpp"

namespace forager::tools {

// The scene's read plan with what the command line says otherwise. Errors: invalid_argument.
[[nodiscard]] hal::Result<reader::ReadPlan> plan_of(const boards::Scene& scene, const ReaderCommand& command);

// Sets the reader up, starts it, shows what it hears, and stops it on every way out. Gives an exit code.
int watch_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene);

}  // namespace forager::tools
