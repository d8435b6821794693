#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

struct BenchCommand {
  // A laboratory run, and stores of ten thousand and a million tags.
  std::vector<std::string> scenes{"scenes/4A.toml", "scenes/store-1e4.toml", "scenes/store-1e6.toml"};
  int repeats = 9;
  bool json = false;
};

// Prints how fast missions and the paths between bytes and decisions are, beside other ways to do the same
// work in the same process. Gives an exit code of tools/cli_style.hpp: check failed when two ways do not come
// to the same result.
int run_bench_speed(const BenchCommand& command);

struct AccuracyCommand {
  std::uint64_t seed = 1;
  int repeats = 5;
  double effort = 1.0;
  std::string csv;   // file to write, "-": stdout; empty: none
  std::string html;  // likewise
  bool json = false;
};

// Prints what every way to compute something costs and how far it is from the exact answer, with the Pareto
// front marked. Gives an exit code of tools/cli_style.hpp.
int run_bench_accuracy(const AccuracyCommand& command);

// Adds `forager bench` with its measurements; exit_code gets its result when one runs.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
