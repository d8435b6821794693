// One seed, one mission: the same decisions, poses, packets and frames, byte for byte.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/boards/flown_mission.hpp"
#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

class RepeatedMission : public testing::Test {
 protected:
  // The journal, wire bytes included.
  std::string journal_of(const Scene& scene, std::uint64_t seed, const char* name) {
    (void)fly(scene, {.seed = seed, .journal = folder_.file(name), .wire = true});
    return folder_.read(name);
  }
  test::ScratchFolder folder_;
};

TEST_F(RepeatedMission, TheSameSeedGivesTheSameJournalWithEveryWireByte) {
  const Scene scene = published_scene("4A");
  const std::string once = journal_of(scene, 3, "once");
  ASSERT_GT(once.size(), 100'000U);
  ASSERT_NE(once.find(" tx "), std::string::npos);
  ASSERT_NE(once.find(" rx "), std::string::npos);
  EXPECT_TRUE(once == journal_of(scene, 3, "again"));
}

TEST_F(RepeatedMission, AnotherSeedGivesAnotherMission) {
  const Scene scene = test_scene("small");
  EXPECT_TRUE(journal_of(scene, 1, "one") != journal_of(scene, 2, "two"));
}

TEST_F(RepeatedMission, ListeningToTheWireChangesNothing) {
  const Scene scene = test_scene("small");
  const FlownMission quiet = fly(scene, {.seed = 5});
  const FlownMission loud = fly(scene, {.seed = 5, .wire = true});
  ASSERT_EQ(quiet.path.size(), loud.path.size());
  for (std::size_t i = 0; i < quiet.path.size(); ++i)
    ASSERT_EQ(quiet.path[i].pose_world.position.x, loud.path[i].pose_world.position.x) << i;
  EXPECT_EQ(quiet.summary.reads, loud.summary.reads);
  EXPECT_EQ(quiet.summary.sim_time_s, loud.summary.sim_time_s);
}

// Text form of a mission's journal marks: its end in words, then "seconds digest" per line.
std::string marks_of(const FlownMission& mission) {
  std::string out = fmt::format("{} of {} tags, {} reads, {}\n", mission.summary.tags_read,
                                mission.summary.tags_present.value_or(0), mission.summary.reads,
                                to_string(mission.summary.end));
  for (const JournalMark& mark : mission.journal)
    out += fmt::format("{:.2f} {:016x}\n", mark.at_s, mark.digest);
  return out;
}

// The file without its lines of explanation.
std::string stored_marks(const std::string& path) {
  std::ifstream file(path);
  std::string out;
  for (std::string line; std::getline(file, line);)
    if (!line.starts_with('#')) out += line + "\n";
  return out;
}

constexpr const char* kExplanation =
    "# Digests of the journal of tests/data/mission/small.toml, seed 1, wire bytes included, every ten "
    "seconds.\n"
    "# Every build must give the same: any optimisation, compiler or sanitizer. Written by\n"
    "# FORAGER_RENEW_GOLDEN=1 boards_tests --gtest_filter='RepeatedMission.EveryBuild*'\n";

TEST_F(RepeatedMission, EveryBuildFliesTheSameBytes) {
  const std::string golden = test::data_path("mission/small_seed1.txt");
  const FlownMission mission = fly(test_scene("small"), {.seed = 1, .wire = true});
  RecordProperty("journal_digest", fmt::format("{:016x}", mission.digest()));
  if (std::getenv("FORAGER_RENEW_GOLDEN") != nullptr) {
    std::ofstream(golden) << kExplanation << marks_of(mission);
    GTEST_SKIP() << "wrote " << golden;
  }
  EXPECT_EQ(marks_of(mission), stored_marks(golden))
      << "The first line that differs says in which ten seconds the missions part.\n"
         "If behaviour was meant to change: run this test with FORAGER_RENEW_GOLDEN=1 in the environment "
         "and\n"
         "commit the file. If not, or if only some builds differ, something depends on the build: arguments\n"
         "evaluated in another order, a hash table walked, arithmetic contracted or folded.";
}

}  // namespace
}  // namespace forager::boards
