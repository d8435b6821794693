#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "boards/mavlink_bench.hpp"

namespace CLI {
class App;
}

namespace forager::tools {

struct MavlinkCommand {
  std::string board = "sim";
  boards::MavlinkPlace place;
  std::string scene;  // of an emulated autopilot; empty: the bench's own
  std::uint64_t seed = 1;
  bool real_time = false;
  bool json = false;
  double for_s = 0.0;
  double every_s = 1.0;

  // listen
  bool raw = false;
  bool silent = false;           // send nothing, not even heartbeats
  std::vector<std::string> ask;  // names of messages to be sent by the autopilot
  double rate_hz = 4.0;
};

// Shows what is said on a MAVLink line. Gives an exit code of tools/cli_style.hpp: failure when no autopilot
// was heard in all that time.
int run_mavlink_listen(const MavlinkCommand& command);

// Adds `forager mavlink`; exit_code gets its result when it runs.
void add_mavlink_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
