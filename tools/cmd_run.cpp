#include "tools/cmd_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "boards/output_guard.hpp"
#include "boards/replay_run.hpp"
#include "boards/run.hpp"
#include "boards/run_clock.hpp"
#include "boards/run_journal.hpp"
#include "reader/inventory_store.hpp"
#include "tools/cli_checks.hpp"
#include "tools/cli_style.hpp"
#include "tools/run_loop.hpp"
#include "tools/run_output.hpp"
#include "tools/run_report.hpp"
#include "tools/run_watch.hpp"

namespace forager::tools {
namespace {

using boards::Run;
using WallClock = std::chrono::steady_clock;

struct Files {
  std::string folder;            // empty: none
  std::filesystem::path parent;  // nearest folder around it that was there before
  std::string report, inventory, journal;
};

constexpr const char* kInventoryTails[] = {"", "-wal", "-shm"};

hal::ErrorCode code_of(const std::error_code& error) {
  if (error == std::errc::permission_denied || error == std::errc::read_only_file_system)
    return hal::ErrorCode::permission;
  if (error == std::errc::not_a_directory || error == std::errc::file_exists)
    return hal::ErrorCode::not_present;
  return hal::ErrorCode::io;
}

// A simulated run may be repeated into the same folder; the inventory of a real place is never overwritten.
hal::Result<Files> make_files(const RunCommand& command, const boards::Scene& scene,
                              const boards::Board& board) {
  if (command.no_files) return Files{};
  Files files;
  files.folder = !command.output.empty()
                     ? command.output
                     : fmt::format("out/{}-{}-{}", scene.name, to_string(scene.mission.policy), command.seed);
  std::error_code error;
  files.parent = std::filesystem::absolute(files.folder, error);
  while (!std::filesystem::exists(files.parent, error) && files.parent.has_relative_path())
    files.parent = files.parent.parent_path();
  std::filesystem::create_directories(files.folder, error);
  if (error)
    return hal::fail(code_of(error), files.folder, "create output folder", "cannot be created",
                     "Choose another with --output.", error.value());
  files.report = files.folder + "/report.html";
  // A simulated run goes without its inventory where SQLite is not built in; a real one is refused later.
  if (reader::have_sqlite_inventory() || board.kind != boards::BoardKind::sim)
    files.inventory = files.folder + "/inventory.sqlite";
  files.journal = files.folder + "/journal.txt";
  if (board.kind != boards::BoardKind::sim && std::filesystem::exists(files.inventory, error))
    return hal::fail(hal::ErrorCode::invalid_argument, files.inventory, "create inventory",
                     "is already there",
                     "Choose another folder with --output; an inventory is never overwritten.");
  if (!files.inventory.empty())
    for (const char* tail : kInventoryTails) std::filesystem::remove(files.inventory + tail, error);
  std::filesystem::remove(files.report, error);  // an old page beside a new journal would mislead
  return files;
}

// A run that could not be put together leaves nothing behind.
void remove_files(const Files& files) {
  if (files.folder.empty()) return;
  std::error_code error;
  std::filesystem::remove(files.journal, error);
  for (const char* tail : kInventoryTails) std::filesystem::remove(files.inventory + tail, error);
  // Only what is empty goes.
  for (auto folder = std::filesystem::absolute(files.folder, error);
       folder != files.parent && std::filesystem::remove(folder, error);)
    folder = folder.parent_path();
}

hal::Result<boards::Scene> scene_for(const RunCommand& command) {
  auto scene = boards::load_scene(command.scene);
  if (!scene || command.policy.empty()) return scene;
  auto policy = boards::policy_from(command.policy);
  if (!policy) return hal::fail(std::move(policy).error());
  FORAGER_TRY(boards::change_policy(*scene, *policy));
  return scene;
}

// A mission that did not go as it should is said so on stderr too, for whoever only looks there.
int judge(const boards::RunSummary& summary) {
  using flight::EndReason;
  const auto bad = [&](hal::ErrorCode code, std::string_view mend) {
    return complain({code, "mission " + summary.scene, std::string(to_string(summary.end)), summary.detail,
                     std::string(mend), 0});
  };
  if (summary.radio_may_be_on)
    (void)complain({hal::ErrorCode::disconnected, "reader", "stop",
                    "it did not confirm its stop and may go on radiating", "Stop it, or take its power off.",
                    0});
  if (summary.crashes > 0) {
    (void)complain({hal::ErrorCode::io, "mission " + summary.scene, "fly",
                    fmt::format("the vehicle touched something or came down hard, {} times", summary.crashes),
                    "See the map in the report.", 0});
    return kExitCheckFailed;
  }
  switch (summary.end) {
    case EndReason::refused:
      (void)bad(hal::ErrorCode::refused, "Mend what the autopilot names.");
      return kExitCheckFailed;
    case EndReason::autopilot_lost:
      return bad(hal::ErrorCode::disconnected, "Check the autopilot's power, cable and address.");
    case EndReason::reader_lost:
      return bad(hal::ErrorCode::disconnected, "Check the reader's power, network and address.");
    case EndReason::pose_lost:
      return bad(hal::ErrorCode::disconnected, "Check the localisation camera and what it sees.");
    case EndReason::store_failed:
      return bad(hal::ErrorCode::io, "Check the disk of the output folder.");
    default:
      return summary.radio_may_be_on ? kExitFailure : kExitDone;
  }
}

// The page of the run, then its figures on stdout; what can still be written is written.
int close_run(Run& run, const RunCommand& command, const Files& files, const RunWatch& watch,
              double wall_time_s, hal::Instant ended) {
  const auto summary = run.summary();
  if (!summary) return complain(summary.error());
  int exit_code = judge(*summary);
  std::string text =
      command.json ? summary_json(*summary, wall_time_s) + "\n" : summary_table(*summary, wall_time_s);
  if (!files.folder.empty()) {
    auto data = report_of(run, *summary, watch, wall_time_s, ended);
    const auto written = data ? write_output(files.report, render_html_report(*data))
                              : hal::Result<>(hal::fail(std::move(data).error()));
    if (!written)
      exit_code = complain(written.error());
    else if (!command.json)
      text += fmt::format("  {:<16}{}\n", "report", files.report);
    if (!command.json && files.inventory.empty())
      text += fmt::format("  {:<16}not kept: built without SQLite; install libsqlite3-dev and build again\n",
                          "inventory");
  }
  if (const auto written = write_output("-", text); !written) return complain(written.error());
  return exit_code;
}

// The file of --record. Never fails towards the run; whether all of it was written is asked at the end.
class RecordFile {
 public:
  explicit RecordFile(const RunCommand& command) : path_(command.record) {
    if (path_.empty()) return;
    file_.open(path_, std::ios::binary | std::ios::trunc);
    recording_ = {[this](std::string_view line) { file_ << line; },
                  fields_of(boards::RecordedRun{command.scene, command.policy, command.board, command.seed})};
  }
  [[nodiscard]] const boards::RunRecording* recording() const {
    return path_.empty() ? nullptr : &recording_;
  }
  [[nodiscard]] hal::Result<> check() {
    if (path_.empty() || file_.flush()) return {};
    return hal::fail(hal::ErrorCode::io, path_, "write recording", "cannot be written",
                     "Choose another file with --record, and see whether the disk is full.");
  }

 private:
  std::string path_;
  std::ofstream file_;
  boards::RunRecording recording_;
};

}  // namespace

int run_run_command(const RunCommand& command) {
  const auto scene = scene_for(command);
  if (!scene) return complain(scene.error());
  const auto board = boards::load_board(command.board);
  if (!board) return complain(board.error());
  const auto guard = boards::OutputGuard::start(*board, {.reader = true}, "forager run");
  if (!guard) return complain(guard.error());
  const auto files = make_files(command, *scene, *board);
  if (!files) return complain(files.error());

  RunWatch watch(
      {.json = command.json, .progress = !command.json && !command.quiet && isatty(STDERR_FILENO) != 0});
  auto journal = boards::RunJournal::open(
      files->journal, [&watch](hal::Instant now, std::string_view source, std::string_view text) {
        watch.note(now, source, text);
      });
  if (!journal) return complain(journal.error());

  const bool real = command.real_time || command.speed != 1.0 || board->kind != boards::BoardKind::sim;
  const auto clock = real ? boards::make_real_clock(command.speed) : boards::make_virtual_clock();
  RecordFile record(command);
  if (const auto opened = record.check(); !opened) {
    remove_files(*files);
    return complain(opened.error());
  }
  auto run = Run::prepare(*scene, *board,
                          {.seed = command.seed,
                           .inventory_path = files->inventory,
                           .journal = journal->get(),
                           .journal_wire = command.wire,
                           .recording = record.recording()},
                          clock->now());
  if (!run) {
    remove_files(*files);
    return complain(run.error());
  }
  if (const auto armed = (*guard)->arm(); !armed) return complain(armed.error());
  const auto wall_start = WallClock::now();
  const auto flown = run_to_end(**run, *clock, watch);
  const double wall_time_s = std::chrono::duration<double>(WallClock::now() - wall_start).count();
  watch.finish();
  int exit_code = close_run(**run, command, *files, watch, wall_time_s, clock->now());
  if (!(*journal)->flush())
    exit_code = complain(
        {hal::ErrorCode::io, files->journal, "write journal", "cannot be written", "Is the disk full?", 0});
  if (const auto written = record.check(); !written) exit_code = complain(written.error());
  return flown ? exit_code : complain(flown.error());
}

void add_run_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<RunCommand>();
  CLI::App* sub = app.add_subcommand("run", "Fly a mission: every device emulated, or those of a board file");
  sub->add_option("scene", command->scene, "Scene file, such as scenes/4A.toml")->required();
  sub->add_option("--board", command->board, "'sim' or a board file")->capture_default_str();
  sub->add_option("--seed", command->seed, "Seed of everything random")
      ->capture_default_str()
      ->check(WholeNumber());
  sub->add_option("--policy", command->policy,
                  "Instead of the scene's: stigmergy, static, dead_reckoning, stop_and_rotate, random_walk");
  sub->add_option("--output", command->output, "Folder for report, inventory and journal");
  sub->add_flag("--no-files", command->no_files, "Write no files");
  sub->add_flag("--real-time", command->real_time, "At the pace of the clock instead of as fast as possible");
  sub->add_option("--speed", command->speed, "Real time, this many times as fast (emulated devices only)")
      ->check(NumberBetween(0.01, 1000.0));
  sub->add_flag("--json", command->json, "JSON lines on stdout; the last one is the summary");
  sub->add_flag("--quiet", command->quiet, "No progress line");
  sub->add_flag("--wire", command->wire, "Bytes of both links into the journal too");
  sub->add_option("--record", command->record,
                  "File for what passes between drivers and devices; see replay");
  sub->callback([command, &exit_code] { exit_code = run_run_command(*command); });
}

}  // namespace forager::tools
