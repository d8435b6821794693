// Worlds that are not written out in a scene: made-up stores and tag files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "boards/sim_air.hpp"
#include "boards/world_builder.hpp"
#include "tests/boards/flown_mission.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

constexpr const char* kBare = R"(
scene = { name = "x" }
reader = { session = "S0", port = [{ port = 1, bearing_deg = 0 }] }
mission = { policy = "static", time_limit_s = 5 }
)";

class SceneStoreTest : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  [[nodiscard]] hal::Result<Scene> scene(const std::string& world) const {
    put("x.toml", kBare + world);
    return load_scene(folder_.file("x.toml"));
  }
  test::ScratchFolder folder_;
};

TEST_F(SceneStoreTest, AStoreIsTheSameForTheSameSeed) {
  const auto store = scene("world.generate = { kind = \"halls\", tags = 2000 }\n");
  ASSERT_TRUE(store) << describe(store.error());
  const mocks::World once = build_world(*store, 1);
  const mocks::World again = build_world(*store, 1);
  const mocks::World other = build_world(*store, 2);
  ASSERT_EQ(once.tags.size(), 2000U);
  EXPECT_GT(once.obstacles.size(), 5U);
  EXPECT_EQ(once.tags.position(1234), again.tags.position(1234));
  EXPECT_NE(once.tags.position(1234), other.tags.position(1234));
  EXPECT_EQ(facts_of(*store, once, 1).tags.size(), 2000U);
  EXPECT_EQ(facts_of(*store, once, 1).tags.epc_hex(7), once.tags.epc_hex(7));
}

TEST_F(SceneStoreTest, GroupsAndStoreNeverShareAnEpc) {
  const auto both = scene(
      "world.generate = { kind = \"aisles\", tags = 500 }\n"
      "world.groups = [{ tags = 500, centres = [[1, 1, 1]] }]\n");
  ASSERT_TRUE(both) << describe(both.error());
  const mocks::World world = build_world(*both, 1);
  std::set<std::string> epcs;
  for (std::size_t i = 0; i < world.tags.size(); ++i) epcs.insert(world.tags.epc_hex(i));
  EXPECT_EQ(epcs.size(), 1000U);
}

TEST_F(SceneStoreTest, ATagFileIsTakenFromTheScenesFolder) {
  put("tags.csv", "epc,x,y,z,wanted\n3034257bf7194e4000001a85,1,0,1.5,1\n3035,1,0.5,1.5,0\n");
  const auto read = scene("world.tag_file = \"tags.csv\"\n");
  ASSERT_TRUE(read) << describe(read.error());
  const mocks::World world = build_world(*read, 1);
  ASSERT_EQ(world.tags.size(), 2U);
  EXPECT_EQ(world.tags.epc_hex(1), "3035");
  EXPECT_FALSE(world.tags.wanted(1));
}

TEST_F(SceneStoreTest, MistakesInATagFileAreTheScenes) {
  const auto missing = scene("world.tag_file = \"none.csv\"\n");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, hal::ErrorCode::not_present);
  put("tags.csv", "epc,x,y,z\n3035,1,2\n");
  const auto broken = scene("world.tag_file = \"tags.csv\"\n");
  ASSERT_FALSE(broken);
  EXPECT_THAT(describe(broken.error()), HasSubstr("tags.csv"));
  EXPECT_THAT(describe(broken.error()), HasSubstr("line 2, column 9"));
}

// Wanted ones, bystanders and EPCs of any length are told apart in the summary.
TEST_F(SceneStoreTest, TheSummaryKnowsTheTagsOfAFile) {
  put("tags.csv",
      "epc,x,y,z,wanted\n3034257bf7194e4000001a85,0.8,0,1.8,1\n3035,0.8,0.1,1.8,1\n3036,0.8,-0.1,1.8,0\n"
      "3034257bf7194e4000001a86,500,0,1.8,1\n");
  const auto read = scene("world.tag_file = \"tags.csv\"\nworld.radio = { spread_db = 0 }\n");
  ASSERT_TRUE(read) << describe(read.error());
  const FlownMission mission = fly(*read, {.seed = 1});
  EXPECT_EQ(mission.summary.tags_present, 3U);
  EXPECT_EQ(mission.summary.tags_read, 2U);
  EXPECT_EQ(mission.summary.other_tags_read, 1U);
}

TEST_F(SceneStoreTest, EverySkipReachesTheAir) {
  const auto all = scene("world.skip = {}\n");
  const auto none = scene(
      "world.skip = { grid = false, hazard_cut = 0, behind = false, blind_antennas = false, silent = false, "
      "unchanged_m = 0, unchanged_deg = 0 }\n");
  ASSERT_TRUE(all);
  ASSERT_TRUE(none) << describe(none.error());
  const mocks::AirParameters on = air_of(*all);
  const mocks::AirParameters off = air_of(*none);
  EXPECT_TRUE(on.skip_by_grid && on.skip_behind && on.skip_blind_antennas && on.skip_silent);
  EXPECT_FALSE(off.skip_by_grid || off.skip_behind || off.skip_blind_antennas || off.skip_silent);
  EXPECT_GT(on.hazard_cut, 0.0);
  EXPECT_EQ(off.hazard_cut, 0.0);
  EXPECT_GT(on.unchanged_m * on.unchanged_rad, 0.0);
  EXPECT_EQ(off.unchanged_m + off.unchanged_rad, 0.0);
}

}  // namespace
}  // namespace forager::boards
