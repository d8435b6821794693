#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct GuardCommand {
  std::string board;
  bool json = false;
};

// Puts every real output of a board file into its safe state: brakes locked, ESCs on their stop pulse,
// and, where the file has the table [reader], the reader silent. For after a crash: systemd's ExecStopPost.
// Gives an exit code of tools/cli_style.hpp: usage when the file names no real output; failure, or what its
// cause means, when one of them could not be told.
int run_guard_command(const GuardCommand& command);

// Adds `forager guard`; exit_code gets its result when it runs.
void add_guard_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
