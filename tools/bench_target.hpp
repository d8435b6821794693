#pragma once

#include <memory>
#include <optional>
#include <string>

#include "boards/bench_devices.hpp"
#include "boards/board.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"

namespace CLI {
class App;
}

namespace forager::tools {

// Where a bench command finds its device, as the command line says.
struct BenchTarget {
  std::string board;       // empty: this machine, no names; "sim": an emulated one; else a board file
  bool real_time = false;  // of an emulated one
  bool json = false;
};
// --board and --json; with `timed` also --real-time, for commands that take time.
void add_target_options(CLI::App* sub, BenchTarget& target, bool timed);

// The machine and the names of a bench command.
struct BenchPlace {
  boards::BenchBoard names;
  std::unique_ptr<hal::Journal> journal;  // before the machine, which borrows it
  std::unique_ptr<boards::BenchMachine> machine;
};
// Errors: those of load_board(). Opens no device.
[[nodiscard]] hal::Result<BenchPlace> open_place(const BenchTarget& target);

}  // namespace forager::tools
