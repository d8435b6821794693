#pragma once

#include <string>

namespace CLI {
class App;
}

namespace forager::tools {

enum class EscTask { list, run, calibrate, stop };

struct EscCommand {
  EscTask task = EscTask::list;
  std::string board = "sim";
  bool arm = false;
  bool real_time = false;    // for emulated ESCs, whose time otherwise jumps
  bool battery_off = false;  // a person's word, where the program cannot switch it
  bool json = false;
  bool pulses = false;        // every change of a pulse as a note
  std::string props_off;      // the sentence
  std::string motor = "all";  // or the name of one
  double throttle = 0.0;      // 0..1
  double hold_s = 0.0;        // after the ramp has begun
  double connect_s = 10.0;    // for a person to connect the battery
};

// Drives ESCs from the bench: emulated ones, or those of a board file. Gives an exit code of
// tools/cli_style.hpp: usage without --arm, without the sentence or with a motor that is none; failure when
// an output failed or a signal ended it; check failed when an emulated ESC has not done what it should.
// Whatever the way out, stop pulses are on the lines.
int run_esc_command(const EscCommand& command);

// Adds `forager esc`; exit_code gets its result when it runs.
void add_esc_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
