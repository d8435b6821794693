#include "tools/cmd_guard.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "boards/board.hpp"
#include "boards/guard_outputs.hpp"
#include "boards/run_clock.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

std::string line_of(const boards::SafeOutput& output, bool json) {
  if (!json)
    return fmt::format("{}: {}\n", one_line(output.output),
                       output.error ? "NOT SAFE: " + one_line(hal::describe(*output.error)) : "safe");
  nlohmann::ordered_json line{{"event", "output"}, {"output", output.output}, {"safe", !output.error}};
  if (output.error) line["error"] = hal::describe(*output.error);
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

int run_guard_command(const GuardCommand& command) {
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const boards::OutputScope all{.brakes = true, .escs = true, .reader = board->reader_named};
  if (!has_real_outputs(*board, all))
    return complain_usage(fmt::format(
        "{} names no real output: no reader, and neither brakes nor ESCs that could move", command.board));
  const auto outcome = make_outputs_safe(*board, all, *boards::make_real_clock(1.0));
  std::string text;
  int exit_code = kExitDone;
  for (const boards::SafeOutput& output : outcome) {
    text += line_of(output, command.json);
    if (!output.error) continue;
    const int code = complain(*output.error);
    if (exit_code == kExitDone) exit_code = code;
  }
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return exit_code;
}

void add_guard_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<GuardCommand>();
  CLI::App* guard = app.add_subcommand(
      "guard", "Lock the brakes, stop the ESCs and the reader of a board file whose program is gone");
  guard->add_option("--safe", command->board, "Board file whose outputs are to be made safe, now")
      ->type_name("BOARD")
      ->required();
  guard->add_flag("--json", command->json, "JSON lines on stdout");
  guard->callback([command, &exit_code] { exit_code = run_guard_command(*command); });
}

}  // namespace forager::tools
