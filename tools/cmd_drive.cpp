#include "tools/cmd_drive.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>

#include "boards/drive_campaign.hpp"
#include "boards/hybrid_scene.hpp"
#include "boards/run_journal.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/drive_hybrid.hpp"
#include "tools/drive_output.hpp"
#include "tools/stop_signal.hpp"

namespace forager::tools {
namespace {

using WallClock = std::chrono::steady_clock;

double since(WallClock::time_point start) {
  return std::chrono::duration<double>(WallClock::now() - start).count();
}

// The page and the journal are those of the first run, driven once more on its own.
int write_first_run(const DriveCommand& command, const boards::DriveScene& scene) {
  if (command.html.empty() && command.journal.empty()) return kExitDone;
  auto journal = boards::RunJournal::open(command.journal, {});
  if (!journal) return complain(journal.error());
  boards::DriveRunOptions options;
  options.seed = command.seed;
  options.wire = command.wire;
  options.keep_track = true;
  options.journal = journal->get();
  const auto run = boards::run_drive(scene, options);
  if (!run) return complain(run.error());
  if (!command.journal.empty() && !(*journal)->flush())
    return complain(
        {hal::ErrorCode::io, command.journal, "write", "could not be written", "Check the disk.", 0});
  if (command.html.empty()) return kExitDone;
  if (const auto written = write_output(command.html, drive_page(scene, *run)); !written)
    return complain(written.error());
  return kExitDone;
}

boards::DriveCampaignOptions campaign_of(const DriveCommand& command) {
  boards::DriveCampaignOptions options;
  options.first_seed = command.seed;
  options.runs = command.runs;
  options.wire = command.wire;
  options.faults = command.faults;
  const bool show = !command.quiet && !command.json && isatty(STDERR_FILENO) != 0;
  options.progress = [show](const boards::DriveResult&, std::uint64_t done, std::uint64_t all) {
    if (show && (done % 20 == 0 || done == all))
      std::fprintf(stderr, "\r  %llu of %llu runs%s", static_cast<unsigned long long>(done),
                   static_cast<unsigned long long>(all), done == all ? "\n" : "");
    return !StopSignal::raised();
  };
  return options;
}

int drive_many(const DriveCommand& command, const boards::DriveScene& scene) {
  const auto start = WallClock::now();
  const auto summary = boards::run_campaign(scene, campaign_of(command));
  if (!summary) return complain(summary.error());
  const std::string text =
      command.json ? drive_json(scene, *summary, since(start)) : drive_table(scene, *summary, since(start));
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  if (StopSignal::raised()) return kExitFailure;
  const bool enough =
      static_cast<double>(summary->arrived) >= command.least_arrived * static_cast<double>(summary->runs);
  return enough && summary->out_without_stop == 0 && summary->contacts == 0 ? kExitDone : kExitCheckFailed;
}

int break_many(const DriveCommand& command, const boards::DriveScene& scene) {
  const auto start = WallClock::now();
  const auto faults = boards::run_fault_campaign(scene, campaign_of(command));
  if (!faults) return complain(faults.error());
  const std::string text =
      command.json ? fault_json(scene, *faults, since(start)) : fault_table(scene, *faults, since(start));
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  if (StopSignal::raised()) return kExitFailure;
  bool passed = true;
  for (const boards::DriveFaultSummary& fault : *faults) {
    if (fault.struck == 0)
      fmt::print(stderr, "forager: no run was struck by '{}', which shows nothing: take more runs\n",
                 boards::to_string(fault.fault));
    passed = passed && fault.unsafe == 0 && fault.struck > 0;
  }
  return passed ? kExitDone : kExitCheckFailed;
}

// Scenes with a table [hybrid] have a runner of their own.
int drive_hybrid(const DriveCommand& command) {
  if (command.faults || !command.html.empty() || !command.speed_by.empty())
    return complain_usage("--faults, --html and --speed-by are for scenes that only roll");
  return run_hybrid_drive({.scene = command.scene,
                           .seed = command.seed,
                           .runs = command.runs,
                           .json = command.json,
                           .journal = command.journal,
                           .least_arrived = command.least_arrived});
}

}  // namespace

int run_drive_command(const DriveCommand& command) {
  if (boards::is_hybrid_scene(command.scene)) return drive_hybrid(command);
  auto scene = boards::load_drive_scene(command.scene);
  if (!scene) return complain(scene.error());
  if (!command.speed_by.empty()) scene->drive.steer.speed_by_pitch = command.speed_by == "pitch";
  const StopSignal signals;
  if (const int code = write_first_run(command, *scene); code != kExitDone) return code;
  return command.faults ? break_many(command, *scene) : drive_many(command, *scene);
}

void add_drive_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<DriveCommand>();
  CLI::App* drive = app.add_subcommand("drive", "Drive a scene on wheels, emulated, once or many times");
  drive->add_option("scene", command->scene, "Scene file, such as scenes/course.toml")->required();
  drive->add_option("--seed", command->seed, "Of the first run; each next one has the next")
      ->check(WholeNumber())
      ->capture_default_str();
  drive->add_option("--runs", command->runs, "How many runs; with --faults of each kind")
      ->check(WholeNumber(1, 10'000'000))
      ->capture_default_str();
  drive->add_flag("--faults", command->faults, "Break something in every run, one kind after the other");
  drive->add_flag("--wire", command->wire, "Through MAVLink bytes and servo pulses instead of calls");
  drive->add_option("--speed-by", command->speed_by, "thrust at fixed pitch, or pitch at constant thrust")
      ->check(CLI::IsMember({"thrust", "pitch"}));
  drive->add_option("--html", command->html, "Write a page with a map of the first run, - for stdout");
  drive->add_option("--journal", command->journal, "Write the journal of the first run");
  drive->add_option("--least", command->least_arrived, "Share of the runs that must arrive")
      ->check(NumberBetween(0.0, 1.0))
      ->capture_default_str();
  drive->add_flag("--json", command->json, "One JSON line on stdout");
  drive->add_flag("--quiet", command->quiet, "No progress on stderr");
  drive->callback([command, &exit_code] { exit_code = run_drive_command(*command); });
}

}  // namespace forager::tools
