#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/bench_target.hpp"

namespace forager::tools {

struct SelftestCommand {
  BenchTarget target;
  std::string out;  // lines, as for `forager gpio`
  std::string in;
  std::string serial;  // a port; instead of the lines
  std::uint32_t baud = 115200;
  std::uint32_t count = 100;  // toggles; of a serial port bytes, 4096 unless given
  bool arm = false;
};

// Tests lines that are wired together: an output and an input, or TX and RX of a serial port. Gives
// kExitDone, kExitCheckFailed when what came is not what was sent, else an exit code of tools/cli_style.hpp.
int run_selftest_command(const SelftestCommand& command);

// Adds `forager selftest`; exit_code gets its result when it runs.
void add_selftest_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
