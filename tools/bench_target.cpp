#include "tools/bench_target.hpp"

#include <CLI/CLI.hpp>
#include <utility>

namespace forager::tools {

void add_target_options(CLI::App* sub, BenchTarget& target, bool timed) {
  sub->add_option("--board", target.board,
                  "Board file that names devices, or sim for an emulated machine; without it this machine");
  sub->add_flag("--json", target.json, "JSON lines on stdout");
  if (timed) sub->add_flag("--real-time", target.real_time, "Let an emulated machine live by the clock too");
}

hal::Result<BenchPlace> open_place(const BenchTarget& target) {
  BenchPlace place;
  place.journal = std::make_unique<hal::NullJournal>();
  if (!target.board.empty()) {
    auto board = boards::load_board(target.board);
    if (!board) return hal::fail(std::move(board).error());
    place.board = *std::move(board);
  }
  place.machine = target.board == "sim" ? boards::make_sim_machine(*place.journal, target.real_time)
                                        : boards::make_real_machine(*place.journal);
  return place;
}

hal::Result<std::unique_ptr<boards::OutputGuard>> guard_output(const BenchPlace& place,
                                                               const boards::OutputScope& output,
                                                               const std::string& program) {
  const boards::OutputScope nothing;
  return boards::OutputGuard::start(place.board, place.machine->emulated() ? nothing : output, program);
}

}  // namespace forager::tools
