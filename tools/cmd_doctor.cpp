#include "tools/cmd_doctor.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "boards/board.hpp"
#include "boards/doctor.hpp"
#include "tools/bench_session.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using boards::Check;
using boards::CheckState;

class Report {
 public:
  explicit Report(const DoctorCommand& command)
      : output_(command.json), only_trouble_(command.only_trouble) {}

  void take(const Check& check) {
    ++counts_[static_cast<std::size_t>(check.state)];
    const bool trouble = check.state == CheckState::failed || check.state == CheckState::warned;
    if (only_trouble_ && !trouble) return;
    output_.record({{"event", "check"},
                    {"area", check.area},
                    {"name", check.name},
                    {"state", to_string(check.state)},
                    {"text", check.text},
                    {"mend", check.mend}});
    output_.line(
        fmt::format("{:<8} {:<8} {}: {}", to_string(check.state), check.area, check.name, check.text));
    if (!check.mend.empty()) output_.line(fmt::format("{:<17} mend: {}", "", check.mend));
  }
  int finish() {
    const auto count = [this](CheckState state) { return counts_[static_cast<std::size_t>(state)]; };
    output_.record({{"event", "summary"},
                    {"ok", count(CheckState::ok)},
                    {"warned", count(CheckState::warned)},
                    {"skipped", count(CheckState::skipped)},
                    {"failed", count(CheckState::failed)}});
    output_.line(fmt::format("{} ok, {} warned, {} skipped, {} failed", count(CheckState::ok),
                             count(CheckState::warned), count(CheckState::skipped),
                             count(CheckState::failed)));
    return count(CheckState::failed) > 0 ? kExitCheckFailed : kExitDone;
  }

 private:
  BenchOutput output_;
  bool only_trouble_;
  std::array<int, 4> counts_{};
};

}  // namespace

int run_doctor_command(const DoctorCommand& command) {
  std::optional<boards::Board> board;
  if (!command.board.empty()) {
    auto loaded = boards::load_board(command.board);
    if (!loaded) return complain(loaded.error());
    board = *std::move(loaded);
  }
  Report report(command);
  boards::run_doctor(board ? &*board : nullptr, [&report](const Check& check) { report.take(check); });
  return report.finish();
}

void add_doctor_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<DoctorCommand>();
  CLI::App* doctor = app.add_subcommand(
      "doctor",
      "Look at this machine and at every device of a board: what works, what not, and how to mend it");
  doctor->add_option("BOARD", command->board, "Board file; without it the machine only");
  doctor->add_flag("--json", command->json, "JSON lines on stdout");
  doctor->add_flag("--trouble", command->only_trouble, "Print only what failed or could be better");
  doctor->callback([command, &exit_code] { exit_code = run_doctor_command(*command); });
}

}  // namespace forager::tools
