#pragma once

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "reader/advannet_reader.hpp"
#include "tools/cmd_reader.hpp"

namespace forager::tools {

// The scene's read plan with what the command line says otherwise. Errors: invalid_argument.
[[nodiscard]] hal::Result<reader::ReadPlan> plan_of(const boards::Scene& scene, const ReaderCommand& command);

// How the driver is to behave at a bench.
[[nodiscard]] reader::AdvanNetConfig driver_config(const ReaderCommand& command, const boards::Board& board,
                                                   const boards::Scene& scene);

// With `listen`: shows what a reader sends that runs for somebody else, and neither asks nor tells it
// anything. Gives an exit code: failure when nothing came that was understood.
int listen_to_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene);

// The same for a reader that types as a keyboard; while it is watched its keys come here and nowhere else.
int watch_wedge(const ReaderCommand& command, const boards::Board& board);

// Sets the reader up, starts it, shows what it hears, and stops it on every way out. Gives an exit code.
int watch_reader(const ReaderCommand& command, const boards::Board& board, const boards::Scene& scene);

}  // namespace forager::tools
