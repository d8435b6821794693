#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct RunCommand {
  std::string scene;
  std::string board = "sim";
  std::string policy;  // empty: the scene's
  std::string
      output;  // folder for report.html, inventory.sqlite and journal.txt; empty: out/<scene>-<policy>-<seed>
  std::string record;  // file that takes down what passes between drivers and devices; empty: none
  std::uint64_t seed = 1;
  double speed = 1.0;  // of real time
  bool real_time = false;
  bool json = false;
  bool quiet = false;  // no progress
  bool no_files = false;
  bool wire = false;  // bytes into the journal too
};

// Flies a mission to its end. Gives an exit code of tools/cli_style.hpp: failure when it ended by a lost
// device or an inventory that cannot be written, check failed when it was refused or touched something; both
// with a line on stderr.
int run_run_command(const RunCommand& command);

// Adds `forager run`; exit_code gets its result when it runs.
void add_run_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
