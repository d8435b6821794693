// Whole hybrid missions: rolled and flown through MAVLink bytes and servo pulses, judged by where the
// emulated vehicle truly was.
#include "boards/hybrid_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "mocks/text_journal.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

std::string hop_file() { return test::source_path("scenes/hop.toml"); }

HybridScene hop_scene() { return load_hybrid_scene(hop_file()).value(); }

// The published scene with one piece of text replaced.
hal::Result<HybridScene> changed(const std::string& from, const std::string& to) {
  std::ifstream file(hop_file());
  std::stringstream text;
  text << file.rdbuf();
  std::string all = text.str();
  const auto at = all.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  all.replace(at, from.size(), to);
  auto root = parse_config(all, "hop.toml");
  if (!root) return hal::fail(std::move(root).error());
  return read_hybrid_scene(*root, "hop.toml");
}

TEST(HybridRun, RollsFliesOverTheBarAndRollsOn) {
  const HybridScene scene = hop_scene();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const auto result = run_hybrid(scene, {.seed = seed});
    ASSERT_TRUE(result) << hal::describe(result.error());
    EXPECT_EQ(result->end, flight::HybridEnd::arrived) << result->detail;
    EXPECT_TRUE(result->arrived(scene)) << result->position_error_m;
    EXPECT_EQ(result->hops, 1U);
    EXPECT_GT(result->over_clearance_m, 0.2) << "wheels well above the bar";
    EXPECT_GT(result->side_clearance_m, 0.15) << "nothing touched where it is low";
    EXPECT_LT(result->highest_m, 0.3 + 0.4 + 0.3);
    EXPECT_TRUE(result->braked_in_air) << "it lands on locked wheels";
    EXPECT_GT(result->rolled_m, 5.0) << "most of the way it rolls";
    EXPECT_LT(result->flown_m, 4.0);
    EXPECT_TRUE(result->stands);
    EXPECT_FALSE(result->hung);
  }
}

TEST(HybridRun, EqualSeedsGiveEqualBytes) {
  const HybridScene scene = hop_scene();
  mocks::TextJournal first;
  mocks::TextJournal second;
  ASSERT_TRUE(run_hybrid(scene, {.seed = 3, .journal = &first}));
  ASSERT_TRUE(run_hybrid(scene, {.seed = 3, .journal = &second}));
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_GT(first.count("hybrid "), 8U);
  EXPECT_EQ(first.count("moved its world frame"), 0U) << "the way that was rolled is no jump";
  EXPECT_EQ(first.count("poses jump"), 0U);
}

TEST(HybridRun, LandsWhenThePoseIsLostInTheAir) {
  const HybridScene scene = hop_scene();
  for (const DriveFault fault : {DriveFault::pose_lost, DriveFault::pose_silent}) {
    const auto result = run_hybrid(scene, {.seed = 2, .fault = fault});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->end, flight::HybridEnd::pose_lost) << result->detail;
    EXPECT_TRUE(result->stands) << "down, disarmed and still";
    EXPECT_FALSE(result->hung);
    EXPECT_TRUE(result->braked_in_air);
    EXPECT_LT(result->flown_m, 2.5) << "it does not fly on";
  }
}

TEST(HybridRun, RollsRoundWhatLeavesRoom) {
  auto scene = changed("max = [3.2, 2.5]", "max = [3.2, -0.2]");
  ASSERT_TRUE(scene) << hal::describe(scene.error());
  const auto result = run_hybrid(*scene, {.seed = 1});
  ASSERT_TRUE(result) << hal::describe(result.error());
  EXPECT_EQ(result->hops, 0U);
  EXPECT_EQ(result->highest_m, 0.0);
  EXPECT_TRUE(result->arrived(*scene))
      << result->detail << " " << result->position_error_m << " " << result->side_clearance_m;
}

TEST(HybridRun, RefusesAWallTooHighToHop) {
  const auto scene = changed("height_m = 0.30", "height_m = 2.5");
  ASSERT_TRUE(scene);
  const auto result = run_hybrid(*scene, {.seed = 1});
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, hal::ErrorCode::refused);
  EXPECT_NE(hal::describe(result.error()).find("too_high"), std::string::npos);
}

TEST(HybridRun, RefusesWhatHasNoHeight) {
  const auto scene = changed("height_m = 0.30", "");
  ASSERT_TRUE(scene);
  const auto result = run_hybrid(*scene, {.seed = 1});
  ASSERT_FALSE(result);
  EXPECT_NE(hal::describe(result.error()).find("height_unknown"), std::string::npos);
}

TEST(HybridRun, PrintsTheAssumptionsBesideTheEstimate) {
  const HybridScene scene = hop_scene();
  const flight::EnergyModel energy(scene.energy);
  const auto route = flight::plan_route(scene.places, 0.0, scene.obstacles, scene.route, energy);
  ASSERT_TRUE(route);
  std::string all;
  for (const std::string& line : describe_route(scene, *route)) all += line + "\n";
  for (const char* part : {"no way round on the ground", "about", "assumed: mass 3.50 kg", "measured"})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
}

TEST(HybridScene, SaysWhatIsWrong) {
  const auto refusal = [](const std::string& from, const std::string& to) {
    const auto scene = changed(from, to);
    return scene ? std::string() : hal::describe(scene.error());
  };
  EXPECT_NE(refusal("ceiling_m = 4.0", "ceilling_m = 4.0").find("ceiling_m"), std::string::npos);
  EXPECT_NE(refusal("figure_of_merit = 0.6", "figure_of_merit = 6").find("figure_of_merit"),
            std::string::npos);
  EXPECT_NE(refusal("area_max = [10.5, 2.0]", "area_max = [-10.5, 2.0]").find("area_max"), std::string::npos);
  EXPECT_NE(refusal("area_max = [10.5, 2.0]", "").find("go together"), std::string::npos);
  EXPECT_NE(refusal("height_m = 0.30", "height_m = -1").find("height_m"), std::string::npos);
  EXPECT_NE(refusal("mass_kg = 3.5\n", "mass_kg = 40\n").find("rolling"), std::string::npos);
  EXPECT_TRUE(is_hybrid_scene(hop_file()));
  EXPECT_FALSE(is_hybrid_scene(test::source_path("scenes/course.toml")));
  EXPECT_FALSE(is_hybrid_scene("no such file"));
}

}  // namespace
}  // namespace forager::boards
