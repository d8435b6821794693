#include "tools/cmd_replay.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "boards/replay_run.hpp"
#include "hal/recording.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

struct Tally {
  std::uint64_t calls = 0;
  std::uint64_t arrivals = 0;
  std::uint64_t errors = 0;
};
using Tallies = std::map<std::string, Tally>;

Tallies tallies_of(const std::vector<hal::Record>& records) {
  Tallies tallies;
  for (const hal::Record& record : records) {
    if (record.device == "run" || record.device == "recorder") continue;
    Tally& tally = tallies[record.device];
    ++(record.operation.substr(0, 1) == "<" ? tally.arrivals : tally.calls);
    if (!record.answer) ++tally.errors;
  }
  return tallies;
}

hal::Result<std::vector<hal::Record>> load(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    return hal::fail(hal::ErrorCode::not_present, file, "open recording", "cannot be read",
                     "Record one with: forager run SCENE --record FILE", errno);
  auto records = hal::parse_recording(std::string(std::istreambuf_iterator<char>(in), {}));
  if (records) return records;
  hal::Error error = std::move(records).error();
  error.code = hal::ErrorCode::invalid_argument;
  error.device = file;
  return hal::fail(std::move(error));
}

double length_s(const std::vector<hal::Record>& records) {
  return records.empty() ? 0.0 : hal::to_seconds(records.back().at - records.front().at);
}

void show_text(const std::vector<hal::Record>& records, const std::optional<boards::RecordedRun>& run) {
  fmt::print(
      "recording   {}\n",
      run ? one_line(fmt::format("{}, seed {}, board {}", run->scene, run->seed, run->board)) : "of a bench");
  fmt::print("length      {:.3f} s, {} records\n", length_s(records), records.size());
  for (const auto& [device, tally] : tallies_of(records))
    fmt::print("device      {}: {} calls, {} arrivals, {} errors\n", one_line(device), tally.calls,
               tally.arrivals, tally.errors);
}

void show_json(const std::vector<hal::Record>& records, const std::optional<boards::RecordedRun>& run) {
  nlohmann::json line{{"event", "recording"}, {"length_s", length_s(records)}, {"records", records.size()}};
  if (run) {
    line["scene"] = run->scene;
    line["seed"] = run->seed;
    line["board"] = run->board;
  }
  const auto print = [](const nlohmann::json& json) {
    fmt::print("{}\n", json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  };
  print(line);
  for (const auto& [device, tally] : tallies_of(records))
    print({{"event", "device"},
           {"device", device},
           {"calls", tally.calls},
           {"arrivals", tally.arrivals},
           {"errors", tally.errors}});
}

int run_again(const std::vector<hal::Record>& records, bool json) {
  hal::NullJournal journal;
  const auto outcome = boards::replay_run(records, journal);
  if (!outcome) return complain(outcome.error());
  const std::size_t made = outcome->calls - outcome->calls_left;
  const bool same = !outcome->difference && outcome->calls_left == 0;
  if (json)
    fmt::print("{}\n", nlohmann::json{{"event", "replay"},
                                      {"updates", outcome->ticks},
                                      {"calls", outcome->calls},
                                      {"same", made},
                                      {"identical", same},
                                      {"tags_read", outcome->summary.tags_read},
                                      {"end", to_string(outcome->summary.end)}}
                           .dump());
  else
    fmt::print("replay      {} updates, {} of {} calls the same{}; {} tags read, {}\n", outcome->ticks, made,
               outcome->calls, same ? ", byte for byte" : "", outcome->summary.tags_read,
               to_string(outcome->summary.end));
  if (same) return kExitDone;
  if (outcome->difference)
    static_cast<void>(complain(*outcome->difference));
  else
    static_cast<void>(complain({hal::ErrorCode::protocol, "recording", "replay",
                                fmt::format("{} recorded calls were not made again", outcome->calls_left),
                                "The run was interrupted, or this program decides otherwise", 0}));
  return kExitCheckFailed;
}

}  // namespace

int run_replay_command(const ReplayCommand& command) {
  const auto records = load(command.file);
  if (!records) return complain(records.error());
  const auto run = boards::recorded_run(*records);
  command.json ? show_json(*records, run) : show_text(*records, run);
  return run && !command.show ? run_again(*records, command.json) : kExitDone;
}

void add_replay_command(CLI::App& app, int& exit_code) {
  auto command = std::make_shared<ReplayCommand>();
  CLI::App* sub = app.add_subcommand(
      "replay",
      "Say what a recording holds, and run a recorded mission again before devices that answer from it");
  sub->add_option("file", command->file, "Recording, as run --record writes it")->required();
  sub->add_flag("--show", command->show, "Only say what it holds");
  sub->add_flag("--json", command->json, "JSON lines on stdout");
  sub->callback([command, &exit_code] { exit_code = run_replay_command(*command); });
}

}  // namespace forager::tools
