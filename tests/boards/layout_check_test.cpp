// A list of tags that is wrong here and there, and what a run makes of it.
#include "boards/layout_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "boards/calibration.hpp"
#include "boards/calibration_cells.hpp"
#include "boards/world_builder.hpp"
#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

using testing::ElementsAre;

reader::Epc epc(const std::string& hex) { return reader::Epc::from_hex(hex).value(); }

reader::InventoryItem heard(const std::string& hex, hal::Vec3 from, bool pose_known = true) {
  reader::InventoryItem item;
  item.epc = epc(hex);
  item.best_pose_world.position = from;
  item.pose_known = pose_known;
  return item;
}

TEST(LayoutCheck, SortsTagsByWhereTheyWereHeard) {
  mocks::TagList layout;
  layout.push_back({"30390001", {0.0, 2.0, 1.0}});
  layout.push_back({"30390002", {9.0, 2.0, 1.0}});
  layout.push_back({"30390003", {3.0, 2.0, 1.0}});
  layout.push_back({"30390004", {4.0, 2.0, 1.0}});
  layout.push_back({"303425zz", {4.0, 2.0, 1.0}});  // no EPC: nobody hears it
  layout.push_back({"30390006", {20.0, 0.0, 0.0}});
  const LayoutCheck check =
      check_layout({heard("30390001", {0.5, 0.0, 1.0}), heard("30390002", {0.0, 0.0, 1.0}),
                    heard("30390003", {}, false), heard("30390006", {0.0, 0.0, 0.0}), heard("3039ffff", {})},
                   layout);
  EXPECT_EQ(check.listed, 6U);
  EXPECT_EQ(check.in_place, 1U);
  EXPECT_EQ(check.unplaced, 1U);
  EXPECT_EQ(check.unheard, 2U);
  EXPECT_THAT(check.strangers, ElementsAre(epc("3039ffff")));
  ASSERT_EQ(check.elsewhere.size(), 2U);
  EXPECT_EQ(check.elsewhere[0].epc, epc("30390006")) << "the farthest first";
  EXPECT_EQ(check.elsewhere[0].away_m, 20.0);
  EXPECT_EQ(check.elsewhere[1].listed, (hal::Vec3{9.0, 2.0, 1.0}));
  EXPECT_EQ(check.elsewhere[1].heard_from, (hal::Vec3{0.0, 0.0, 1.0}));
}

TEST(LayoutCheck, AFileThatIsNotThereIsSaid) {
  const auto check = check_layout_file({}, "/no/such/layout.csv");
  ASSERT_FALSE(check);
  EXPECT_EQ(check.error().code, hal::ErrorCode::not_present);
}

std::set<std::string> swapped_epcs(const Scene& scene, std::uint64_t seed) {
  const mocks::World world = build_world(scene, seed);
  std::set<std::string> epcs;
  for (const std::uint32_t tag : build_layout(scene, world, seed).mislabeled)
    epcs.insert(world.tags.epc_hex(tag));
  return epcs;
}

TEST(Mislabeled, AMissionReadsTheSameTagsAndFindsTheWrongLabels) {
  Scene scene = published_scene("1C");
  const FlownMission right = fly(scene);
  EXPECT_FALSE(right.summary.layout) << "a list without faults is no news";
  scene.world.mislabeled = 0.1;
  scene.world.unlisted = 0.05;
  const FlownMission wrong = fly(scene);
  EXPECT_EQ(wrong.digest(), right.digest()) << "paper does not move tags";
  ASSERT_TRUE(wrong.summary.layout);
  const LayoutCheck& check = *wrong.summary.layout;
  EXPECT_EQ(check.listed, 330U - 17U);
  EXPECT_GT(check.strangers.size(), 13U);
  EXPECT_LE(check.strangers.size(), 17U);
  // 33 labels along 14 m: about half are swapped over more than the reach.
  const std::set<std::string> swapped = swapped_epcs(scene, 1);
  ASSERT_EQ(swapped.size(), 33U);
  std::size_t right_ones = 0;
  for (const auto& tag : check.elsewhere) right_ones += swapped.count(tag.epc.hex());
  EXPECT_GE(right_ones, 6U);
  EXPECT_LE(check.elsewhere.size() - right_ones, 3U) << "false alarms of 280 tags in place";
  EXPECT_GT(check.in_place, 270U);
}

TEST(Mislabeled, CalibrationLeavesThemOutAndNamesThem) {
  Scene scene = test_scene("calibration");
  scene.world.groups.front().centres.clear();
  for (int box = 0; box < 10; ++box)
    scene.world.groups.front().centres.push_back({0.5 + 2.0 * box, 2.2, 1.8});
  scene.mission.waypoints = {{19.0, 0.0}};
  const auto clean = simulate_recording(scene, 3, 76.0);
  scene.world.mislabeled = 0.1;
  const auto faulty = simulate_recording(scene, 3, 76.0);
  ASSERT_TRUE(clean && faulty);
  EXPECT_TRUE(cells_of(*clean, scene).misplaced.empty());
  CalibrationOptions options;
  options.rician_k_db = scene.world.radio.rician_k_db;
  options.spread_db = scene.world.radio.spread_db;
  const auto fit = calibrate(*faulty, scene, options);
  ASSERT_TRUE(fit) << describe(fit.error());
  const std::set<std::string> swapped = swapped_epcs(scene, 3);
  ASSERT_EQ(swapped.size(), 12U);
  // Not those that were hardly heard, nor labels swapped among neighbours.
  EXPECT_GE(fit->misplaced.size(), 3U);
  for (const MisplacedTag& tag : fit->misplaced) {
    EXPECT_TRUE(swapped.contains(tag.epc)) << tag.epc;
    EXPECT_GE(tag.reads, 3U);
    EXPECT_GT(norm(tag.listed - tag.heard_from), 2.0);
  }
  // What is left tells R0 as if they were not there.
  EXPECT_NEAR(fit->parameters[0].value, scene.world.radio.r0_m, 0.3);
}

}  // namespace
}  // namespace forager::boards
