#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

struct ReproduceCommand {
  std::string folder = "scenes";
  std::uint64_t seeds = 20;
  std::vector<std::string> runs;  // empty: all
  std::string html;               // file; empty: none
  bool json = false;
  bool check = false;  // exit code 4 if the bounds do not hold
};

// Flies the published experiments and prints what came of them beside what was published. Gives an exit code
// of tools/cli_style.hpp.
int run_reproduce_command(const ReproduceCommand& command);

// Adds `forager reproduce`; exit_code gets its result when it runs.
void add_reproduce_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
