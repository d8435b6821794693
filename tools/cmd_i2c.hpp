#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench_target.hpp"

namespace forager::tools {

enum class I2cTask : std::uint8_t { list, scan, read, write };

struct I2cCommand {
  I2cTask task = I2cTask::list;
  BenchTarget target;
  std::string bus = "1";           // scan: "1", "i2c-1", "/dev/i2c-1"
  std::string chip;                // a name of the board file, or BUS@ADDRESS
  std::string reg;                 // read: register to begin with; empty: none is written
  std::uint32_t count = 1;         // read
  std::vector<std::string> bytes;  // write
  bool arm = false;                // write
  double timeout_s = 0.02;         // of one transfer, where the board file names none
};

// Scans an I2C bus, reads from and writes to a chip. Gives an exit code of tools/cli_style.hpp: failure when
// the chip does not answer; `write` needs --arm.
int run_i2c_command(const I2cCommand& command);

// Adds `forager i2c`; exit_code gets its result when it runs.
void add_i2c_command(CLI::App& app, int& exit_code);

}  // namespace forager::tools
