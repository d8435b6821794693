#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace forager::tools {

struct CalibrateCommand {
  std::string reads;
  std::string poses;
  std::string tags;
  std::string scene = "scenes/1B.toml";  // antennas, pattern, T0, power-up limit; what is simulated
  std::optional<double> spread_db;       // held instead of fitted
  std::optional<double> rician_k_db;
  std::string html;
  bool json = false;

  bool published = false;  // fit to the published totals instead
  std::string folder = "scenes";
  std::uint64_t seeds = 3;
  std::uint64_t evaluations = 60;
  std::vector<double> start;  // R0 in m, spread and K in dB; empty: what the scenes say

  std::string simulate;  // folder: write a simulated recording there instead
  double seconds = 120.0;
  std::uint64_t seed = 1;
};

// Fits the radio parameters of a scene to a recorded run or to the published totals, or writes a simulated
// recording to try it on. Gives an exit code of tools/cli_style.hpp: check failed when the data cannot tell a
// parameter, with a line on stderr that names it and says why.
int run_calibrate_command(const CalibrateCommand& command);

// Adds `forager calibrate`; exit_code gets its result when it runs.
void add_calibrate_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
