#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "tools/paired_times.hpp"

namespace CLI {
class App;
}

namespace forager::tools {

struct OverheadCommand {
  std::string gpio;  // CHIP/LINE; empty: not measured, and so on
  std::string i2c;   // BUS@ADDRESS
  std::string usb;   // VID:PID
  unsigned baud = 115200;
  double seconds = 2.0;  // of each measurement
  bool arm = false;
  bool json = false;
};

// One layer beside the vendor's call; without figures it was not measured.
struct OverheadRow {
  std::string name;
  std::string unit;
  std::string ours;  // "DigitalOut::set"
  std::string bare;  // "libgpiod 1.6.3"
  std::optional<PairedFigures> figures{};
  std::string skipped{};  // why
};

// Errors: those of the two sides.
[[nodiscard]] hal::Result<OverheadRow> measure_overhead(const boards::OverheadContest& contest,
                                                        const PairedOptions& options);

// One JSON object on one line (no line break).
[[nodiscard]] std::string overhead_json(const OverheadRow& row);
[[nodiscard]] std::string overhead_table(std::span<const OverheadRow> rows);

// Prints what the layer costs over the vendors' calls, made in turn in this process. Gives an exit code of
// tools/cli_style.hpp: that of the first device that was asked for and failed.
int run_bench_overhead(const OverheadCommand& command);

void add_overhead_command(CLI::App& bench, int& exit_code);

}  // namespace forager::tools
