#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/bench_target.hpp"

namespace forager::tools {

enum class PwmTask : std::uint8_t { list, set, sweep };

struct PwmCommand {
  PwmTask task = PwmTask::list;
  BenchTarget target;
  std::string output;  // a servo of the board file, CHIP/CHANNEL, or BUS@ADDRESS/CHANNEL
  bool arm = false;
  double pulse_us = 0.0;               // set
  double from_us = 1000.0;             // sweep: there ...
  double to_us = 2000.0;               // ... and back again
  double over_s = 2.0;                 // one way
  double hold_s = 0.0;                 // set
  std::optional<double> frequency_hz;  // empty: the board file's, or 50
};

// Lists PWM chips, makes pulses on one output. Gives an exit code of tools/cli_style.hpp. What makes pulses
// needs --arm, and ends without pulses, whatever the way out.
int run_pwm_command(const PwmCommand& command);

// Adds `forager pwm`; exit_code gets its result when it runs.
void add_pwm_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
