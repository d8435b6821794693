#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

enum class BrakeTask : std::uint8_t { list, set, watch };

struct BrakeCommandLine {
  BrakeTask task = BrakeTask::list;
  std::string board = "sim";
  bool arm = false;
  bool real_time = false;  // for emulated brakes, whose time otherwise jumps
  bool json = false;
  double left = 1.0;  // 0 open .. 1 locked
  double right = 1.0;
  double hold_s = 0.0;     // then both lock
  double for_s = 0.0;      // of watching; 0: until told to stop
  double connect_s = 5.0;  // for the autopilot's first heartbeat
};

// Moves the brakes of a board file, or emulated ones, from the bench. Gives an exit code of
// tools/cli_style.hpp: usage without --arm or without [brakes]; failure when a brake failed or a signal ended
// `set`. Whatever the way out, both brakes are locked and held.
int run_brake_command(const BrakeCommandLine& command);

// Adds `forager brake`; exit_code gets its result when it runs.
void add_brake_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
