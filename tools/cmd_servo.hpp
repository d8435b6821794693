#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/bench_target.hpp"

namespace forager::tools {

enum class ServoTask : std::uint8_t { list, set, sweep, trim };

struct ServoCommand {
  ServoTask task = ServoTask::list;
  BenchTarget target;
  std::string servo;  // name of the board file; "sim" on the emulated machine
  bool arm = false;
  double place = 0.5;   // set, trim: 0 to 1 of the travel
  double from = 0.0;    // sweep: there ...
  double to = 1.0;      // ... and back again
  double over_s = 2.0;  // one way
  double hold_s = 0.0;  // set, trim
  double trim_us = 0.0;
};

// Moves a servo of the board file within its end stops and no faster than its slew limit. Gives an exit code
// of tools/cli_style.hpp. What moves needs --arm and ends at the servo's safe place, held or released as the
// board file says, whatever the way out.
int run_servo_command(const ServoCommand& command);

// Adds `forager servo`; exit_code gets its result when it runs.
void add_servo_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
