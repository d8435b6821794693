#include "boards/replay_run.hpp"

#include <utility>

#include "boards/board.hpp"
#include "boards/policies.hpp"
#include "boards/recorded_devices.hpp"
#include "boards/run.hpp"
#include "boards/scene.hpp"

namespace forager::boards {
namespace {

bool is_run(const hal::Record& record, std::string_view operation) {
  return record.device == "run" && record.operation == operation;
}

hal::Result<Scene> scene_of(const RecordedRun& run) {
  auto scene = load_scene(run.scene);
  if (!scene || run.policy.empty()) return scene;
  const auto policy = policy_from(run.policy);
  if (!policy) return hal::fail(policy.error());
  FORAGER_TRY(change_policy(*scene, *policy));
  return scene;
}

}  // namespace

hal::Fields fields_of(const RecordedRun& run) {
  return {run.scene, run.policy, run.board, hal::field(run.seed)};
}

std::optional<RecordedRun> recorded_run(const std::vector<hal::Record>& records) {
  for (const hal::Record& record : records) {
    if (!is_run(record, "<begin") || !record.answer || record.answer->size() != 4) continue;
    const hal::Fields& fields = *record.answer;
    const auto seed = hal::integer_in(fields[3]);
    if (!seed || *seed < 0) return std::nullopt;
    return RecordedRun{fields[0], fields[1], fields[2], static_cast<std::uint64_t>(*seed)};
  }
  return std::nullopt;
}

hal::Result<ReplayOutcome> replay_run(const std::vector<hal::Record>& records, hal::Journal& journal) {
  const auto what = recorded_run(records);
  if (!what)
    return hal::fail(hal::ErrorCode::invalid_argument, "recording", "replay", "is not that of a run",
                     "Record one with: forager run SCENE --record FILE");
  const auto scene = scene_of(*what);
  if (!scene) return hal::fail(scene.error());
  const auto board = load_board(what->board);
  if (!board) return hal::fail(board.error());
  const hal::Instant start = records.front().at;
  auto devices = replay_devices(records, start);
  const ReplayedDevices& replayed = *devices;
  auto run =
      Run::prepare_with(*scene, *board, {.seed = what->seed, .journal = &journal}, start, std::move(devices));
  if (!run) return hal::fail(std::move(run).error());
  ReplayOutcome outcome;
  for (const hal::Record& record : records) {
    if (!is_run(record, "<tick")) continue;
    (*run)->update(record.at);
    ++outcome.ticks;
  }
  outcome.calls = replayed.calls();
  outcome.calls_left = replayed.calls_left();
  outcome.difference = replayed.difference();
  auto summary = (*run)->summary();
  if (!summary) return hal::fail(std::move(summary).error());
  outcome.summary = *std::move(summary);
  return outcome;
}

}  // namespace forager::boards
