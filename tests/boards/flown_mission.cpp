#include "tests/boards/flown_mission.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "boards/run.hpp"
#include "boards/run_journal.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

constexpr hal::Duration kPatience = std::chrono::hours(2);
constexpr hal::Duration kMarkEvery = std::chrono::seconds(10);

Scene loaded(const std::string& path) {
  auto scene = load_scene(path);
  EXPECT_TRUE(scene) << describe(scene.error());
  return scene ? *scene : Scene{};
}

}  // namespace

double FlownMission::coverage() const {
  const double present = static_cast<double>(summary.tags_present.value_or(0));
  return present > 0.0 ? static_cast<double>(summary.tags_read) / present : 0.0;
}

Scene published_scene(const std::string& name) {
  return loaded(test::source_path("scenes/") + name + ".toml");
}

Scene test_scene(const std::string& name) { return loaded(test::data_path("mission/") + name + ".toml"); }

FlownMission fly(const Scene& scene, const FlyOptions& options) {
  FlownMission flown{.summary = {}, .decisions = {}, .path = {}, .journal = {}};
  auto journal = RunJournal::open(options.journal, {});
  EXPECT_TRUE(journal) << describe(journal.error());
  if (!journal) return flown;
  hal::Instant now;
  RunOptions run_options;
  run_options.seed = options.seed;
  run_options.journal = journal->get();
  run_options.journal_wire = options.wire;
  auto run = Run::prepare(scene, sim_board(), run_options, now);

  EXPECT_TRUE(run) << describe(run.error());
  if (!run) return flown;
  for (hal::Instant mark = now + kMarkEvery;
       !(*run)->done() && hal::to_seconds(now) < hal::to_seconds(kPatience); now += Run::kTick) {
    (*run)->update(now);
    if (now < mark) continue;
    flown.journal.push_back({hal::to_seconds(now), (*journal)->hash()});
    mark += kMarkEvery;
  }
  EXPECT_TRUE((*run)->done()) << scene.name << " seed " << options.seed << " did not end";
  const auto summary = (*run)->summary();
  EXPECT_TRUE(summary) << describe(summary.error());
  if (summary) flown.summary = *summary;
  flown.decisions = (*run)->status().decisions;
  flown.path.assign((*run)->path().begin(), (*run)->path().end());
  flown.journal.push_back({hal::to_seconds(now), (*journal)->hash()});
  EXPECT_TRUE((*journal)->flush());
  return flown;
}

std::vector<FlownMission> fly_seeds(const Scene& scene) {
  std::vector<FlownMission> missions;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) missions.push_back(fly(scene, {.seed = seed}));
  return missions;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2.0;
}

double median_coverage(const std::vector<FlownMission>& missions) {
  std::vector<double> coverages;
  coverages.reserve(missions.size());
  for (const FlownMission& mission : missions) coverages.push_back(mission.coverage());
  return median(std::move(coverages));
}

}  // namespace forager::boards
