#include "tools/cmd_bench.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "boards/scene.hpp"
#include "boards/speed_contest.hpp"
#include "tools/bench_duel.hpp"
#include "tools/bench_jitter.hpp"
#include "tools/bench_mission.hpp"
#include "tools/bench_overhead.hpp"
#include "tools/bench_row.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

std::vector<Duel> hot_paths() {
  std::vector<Duel> duels;
  duels.push_back(advannet_duel());
  duels.push_back(mavlink_encode_duel());
  duels.push_back(mavlink_parse_duel());
  duels.push_back(guard_duel(80, 60));
  duels.push_back(guard_duel(640, 480));
  duels.push_back(new_tags_duel());
  for (boards::SpeedContest& contest : boards::speed_contests())
    duels.push_back({contest.name, contest.unit, contest.peer, contest.items, std::move(contest.ours),
                     std::move(contest.other), std::move(contest.agree)});
  return duels;
}

int print(const std::vector<BenchRow>& rows, bool json) {
  std::string text;
  if (json)
    for (const BenchRow& row : rows) text += bench_json(row) + "\n";
  else
    text = bench_table(rows);
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return kExitDone;
}

void add_accuracy_command(CLI::App& bench, int& exit_code) {
  auto command = std::make_shared<AccuracyCommand>();
  CLI::App* accuracy = bench.add_subcommand(
      "accuracy", "What each way to compute something costs, and how far it is from the exact answer");
  accuracy->add_option("--seed", command->seed, "Of the random samples")
      ->capture_default_str()
      ->check(WholeNumber());
  accuracy->add_option("--repeat", command->repeats, "Measurements of each time, of which the fastest counts")
      ->capture_default_str()
      ->check(WholeNumber(1, 1000));
  accuracy->add_option("--effort", command->effort, "Share of the samples to take, above 0 to 100")
      ->capture_default_str()
      ->check(NumberBetween(1e-3, 100.0));
  accuracy->add_option("--csv", command->csv, "Write the rows as a table for other programs, '-': to stdout")
      ->type_name("FILE");
  accuracy->add_option("--html", command->html, "Write a page with plots, '-': to stdout")->type_name("FILE");
  accuracy->add_flag("--json", command->json,
                     "JSON lines: name, variant, time_ns, max_abs_error, max_rel_error, reference, asked, "
                     "failures, pareto");
  accuracy->callback([command, &exit_code] { exit_code = run_bench_accuracy(*command); });
}

void add_jitter_command(CLI::App& bench, int& exit_code) {
  auto command = std::make_shared<JitterCommand>();
  CLI::App* jitter = bench.add_subcommand(
      "jitter", "How exact software PWM is on this machine, idle and with every processor busy");
  jitter->add_option("--seconds", command->seconds, "Of each of the four measurements")
      ->capture_default_str()
      ->check(NumberBetween(0.1, 3600.0));
  jitter->add_flag("--json", command->json, "JSON lines: name, ours, unit");
  jitter->callback([command, &exit_code] { exit_code = run_bench_jitter(*command); });
}

}  // namespace

int run_bench_speed(const BenchCommand& command) {
  std::vector<BenchRow> rows;
  for (const std::string& path : command.scenes) {
    const auto scene = boards::load_scene(path);
    if (!scene) return complain(scene.error());
    auto flown = bench_mission(*scene, command.repeats);
    if (!flown) return complain(flown.error());
    std::move(flown->begin(), flown->end(), std::back_inserter(rows));
  }
  DuelOptions options;
  options.repeats = command.repeats;
  for (const Duel& duel : hot_paths()) {
    auto row = measure(duel, options);
    if (!row) {
      complain(row.error());
      return kExitCheckFailed;
    }
    rows.push_back(std::move(*row));
  }
  return print(rows, command.json);
}

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* bench = app.add_subcommand("bench", "Measure this machine and this program");
  bench->require_subcommand(1);
  auto command = std::make_shared<BenchCommand>();
  CLI::App* speed = bench->add_subcommand(
      "speed", "How fast missions run and where their time goes; hot paths beside other ways to do the same");
  speed->add_option("--scene", command->scenes, "Mission to fly, every device emulated; may be given again")
      ->allow_extra_args(false)
      ->capture_default_str();
  speed->add_option("--repeat", command->repeats, "Measurements of each, of which the median counts")
      ->capture_default_str()
      ->check(WholeNumber(1, 1000));
  speed->add_flag("--json", command->json,
                  "JSON lines: name, ours, unit, peer, peer_value, ratio = ours / peer_value");
  speed->callback([command, &exit_code] { exit_code = run_bench_speed(*command); });
  add_accuracy_command(*bench, exit_code);
  add_jitter_command(*bench, exit_code);
  add_overhead_command(*bench, exit_code);
}

}  // namespace forager::tools
