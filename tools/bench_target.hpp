#pragma once

#include <memory>
#include <optional>
#include <string>

#include "boards/bench_devices.hpp"
#include "boards/board.hpp"
#include "boards/output_guard.hpp"
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

// The machine of a bench command, and the board file with its names.
struct BenchPlace {
  boards::Board board;
  std::unique_ptr<hal::Journal> journal;  // before the machine, which borrows it
  std::unique_ptr<boards::BenchMachine> machine;
};
// Errors: those of load_board(). Opens no device.
[[nodiscard]] hal::Result<BenchPlace> open_place(const BenchTarget& target);

// Watches over the command that moves this output of the place; to be called before it is opened, and kept
// for longer than it. Nobody watches on an emulated machine. Errors: those of OutputGuard::start().
[[nodiscard]] hal::Result<std::unique_ptr<boards::OutputGuard>> guard_output(
    const BenchPlace& place, const boards::OutputScope& output, const std::string& program);

}  // namespace forager::tools
