#pragma once

#include <cstdint>
#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

struct DriveCommand {
  std::string scene;
  std::uint64_t seed = 1;
  std::uint64_t runs = 1;
  bool faults = false;   // `runs` of every kind of fault
  bool wire = false;     // through MAVLink bytes and servo pulses
  std::string speed_by;  // "thrust", "pitch" or empty: the scene's
  bool json = false;
  bool quiet = false;
  std::string html;             // page of the first run; empty: none
  std::string journal;          // of the first run; empty: none
  double least_arrived = 0.99;  // share of the runs that must arrive
};

// Drives a scene on wheels, emulated, once or many times, and prints a closing table. Exit codes of
// tools/cli_style.hpp: check failed when fewer runs arrived than asked, one left its corridor without
// stopping, or a fault did not end safely within its bound.
int run_drive_command(const DriveCommand& command);

// Adds `forager drive`; exit_code gets its result when it runs.
void add_drive_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
