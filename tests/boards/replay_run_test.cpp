#include "boards/replay_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "boards/board.hpp"
#include "boards/run.hpp"
#include "boards/scene.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

// A whole mission on emulated devices, and what passed between them and their drivers.
struct Flown {
  std::string text;
  RunSummary summary;
};

const Flown& flown() {
  static const Flown once = [] {
    Flown out;
    const RecordedRun what{test::source_path("scenes/3A.toml"), "", "sim", 3};
    const RunRecording recording{[&out](std::string_view line) { out.text += line; }, fields_of(what)};
    const Scene scene = load_scene(what.scene).value();
    hal::NullJournal journal;
    hal::Instant now;
    auto run = Run::prepare(scene, sim_board(),
                            {.seed = what.seed, .journal = &journal, .recording = &recording}, now)
                   .value();
    while (!run->done() && now < hal::Instant{} + std::chrono::hours(1)) run->update(now += Run::kTick);
    out.summary = run->summary().value();
    return out;
  }();
  return once;
}

std::vector<hal::Record> records() { return hal::parse_recording(flown().text).value(); }

TEST(ReplayRun, TheSameMissionComesOutByteForByte) {
  hal::NullJournal journal;
  const auto outcome = replay_run(records(), journal);
  ASSERT_TRUE(outcome) << describe(outcome.error());
  EXPECT_FALSE(outcome->difference) << describe(*outcome->difference);
  EXPECT_EQ(0U, outcome->calls_left);
  EXPECT_GT(outcome->calls, 1000U);
  EXPECT_EQ(flown().summary.reads, outcome->summary.reads);
  EXPECT_GT(outcome->summary.reads, 0U);
  EXPECT_EQ(flown().summary.end, outcome->summary.end);
  EXPECT_DOUBLE_EQ(flown().summary.path_m, outcome->summary.path_m);
}

TEST(ReplayRun, AnotherAnswerOfADeviceShowsWhereTheDriversDiffer) {
  auto changed = records();
  std::size_t seen = 0;
  for (hal::Record& record : changed)
    if (record.operation == "<pose" && ++seen == 200) (*record.answer)[1] = "40.5";  // metres off
  ASSERT_GE(seen, 200U);
  hal::NullJournal journal;
  const auto outcome = replay_run(changed, journal);
  ASSERT_TRUE(outcome) << describe(outcome.error());
  ASSERT_TRUE(outcome->difference);
  EXPECT_THAT(describe(*outcome->difference), HasSubstr("the recording has \"write "));
}

TEST(ReplayRun, ABenchIsNoRun) {
  hal::NullJournal journal;
  const auto refused = replay_run({{hal::Instant{}, "lamp", "set", {"1"}, hal::Fields{}}}, journal);
  ASSERT_FALSE(refused);
  EXPECT_EQ(hal::ErrorCode::invalid_argument, refused.error().code);
}

}  // namespace
}  // namespace forager::boards
