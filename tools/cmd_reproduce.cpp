#include "tools/cmd_reproduce.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string_view>

#include "boards/reproduce.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/reproduce_output.hpp"
#include "tools/reproduce_page.hpp"

namespace forager::tools {
namespace {

void show_progress(std::size_t flown, std::size_t missions, std::string_view run) {
  std::fprintf(stderr, "\r\x1b[Kmission %zu of %zu: %s", flown + 1, missions, std::string(run).c_str());
  std::fflush(stderr);
}

}  // namespace

int run_reproduce_command(const ReproduceCommand& command) {
  boards::ReproduceOptions options;
  options.folder = command.folder;
  options.seeds = command.seeds;
  options.runs = command.runs;
  const bool terminal = isatty(STDERR_FILENO) == 1;
  if (terminal) options.progress = show_progress;
  const auto result = boards::reproduce(options);
  if (terminal) std::fputs("\r\x1b[K", stderr);
  if (!result) return complain(result.error());
  if (!command.html.empty())
    if (const auto written = write_output(command.html, reproduction_page(*result)); !written)
      return complain(written.error());
  const std::string text = command.json ? reproduction_json(*result) : reproduction_table(*result);
  if (command.html != "-")
    if (const auto written = write_output("-", text); !written) return complain(written.error());
  if (!command.check) return kExitDone;
  const auto complaints = result->complaints();
  for (const std::string& complaint : complaints)
    std::fprintf(stderr, "forager: reproduce: %s\n", complaint.c_str());
  return complaints.empty() ? kExitDone : kExitCheckFailed;
}

void add_reproduce_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<ReproduceCommand>();
  CLI::App* reproduce = app.add_subcommand(
      "reproduce", "Fly the published experiments and compare: published, simulated, difference");
  reproduce->add_option("--seeds", command->seeds, "Missions of each experiment, seeds 1 to this")
      ->capture_default_str()
      ->check(WholeNumber(1, 10000));
  reproduce->add_option("--runs", command->runs, "Only these experiments, such as 1A,2B,4.8,ch4-1")
      ->delimiter(',');
  reproduce->add_option("--scenes", command->folder, "Folder of the scene files")->capture_default_str();
  reproduce->add_option("--html", command->html, "Write a page with plots to this file, - for stdout");
  reproduce->add_flag(
      "--json", command->json,
      "JSON lines: run, published, median, p5, p95, difference (coverage in per cent and points), "
      "duration_s; the last row holds rms_points");
  reproduce->add_flag("--check", command->check, "Exit code 4 if a figure is out of its bounds");
  reproduce->callback([command, &exit_code] { exit_code = run_reproduce_command(*command); });
}

}  // namespace forager::tools
