#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct ReplayCommand {
  std::string file;
  bool show = false;  // do not run it again
  bool json = false;
};

// Says what a recording holds, and runs a recorded mission once more before devices that answer from it.
// Gives an exit code of tools/cli_style.hpp: check failed when a driver did something else than recorded.
int run_replay_command(const ReplayCommand& command);

// Adds `forager replay`; exit_code gets its result when it runs.
void add_replay_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
