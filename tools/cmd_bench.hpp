#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct BenchCommand {
  std::string scene = "scenes/4A.toml";
  int repeats = 9;
  bool json = false;
};

// Prints how fast missions and the paths between bytes and decisions are, beside other ways to do the same
// work in the same process. Gives an exit code of tools/cli_style.hpp: check failed when two ways do not come
// to the same result.
int run_bench_speed(const BenchCommand& command);

// Adds `forager bench` with its measurements; exit_code gets its result when one runs.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
