#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench_target.hpp"

namespace forager::tools {

enum class GpioTask : std::uint8_t { list, read, set, watch };

struct GpioCommand {
  GpioTask task = GpioTask::list;
  BenchTarget target;
  std::string chip;                // list: this one only
  std::vector<std::string> lines;  // names of the board file, or CHIP/LINE
  std::string level;               // set: "on" or "off"
  bool arm = false;
  double hold_s = 0.0;
  double for_s = 0.0;  // watch; 0: until told to stop
  bool active_low = false;
  std::string bias;  // "up", "down", "none"; empty: as it is
};

// Lists, reads, sets and watches GPIO lines. Gives an exit code of tools/cli_style.hpp. `set` needs --arm,
// holds for --hold and makes the line inactive, whatever the way out; a line of the board file with at_end
// as_is keeps its level.
int run_gpio_command(const GpioCommand& command);

// Adds `forager gpio`; exit_code gets its result when it runs.
void add_gpio_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
