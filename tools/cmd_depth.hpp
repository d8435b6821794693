#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct DepthCommand {
  bool watch = false;  // else one frame
  std::string board = "sim";
  std::string scene;  // empty: the bench's own
  std::uint64_t seed = 1;
  double speed_m_s = 0.5;
  int sectors = 9;
  double for_s = 0.0;
  double every_s = 0.5;
  double within_s = 2.0;  // for the first frame
  bool real_time = false;
  bool json = false;
};

// Shows what the depth camera sees and what the obstacle guard would decide. Gives an exit code of
// tools/cli_style.hpp: failure when no frame came.
int run_depth_command(const DepthCommand& command);

// Adds `forager depth`; exit_code gets its result when it runs.
void add_depth_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
