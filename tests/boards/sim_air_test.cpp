#include "boards/sim_air.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"
#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

TEST(SimAir, APublishedSceneFliesAtSlotLevel) {
  Scene scene = published_scene("4A");
  scene.world.air.model = AirModel::slot;
  std::vector<double> coverage;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const FlownMission mission = fly(scene, {.seed = seed});
    EXPECT_EQ(mission.summary.end, flight::EndReason::no_new_tags) << mission.summary.detail;
    EXPECT_EQ(mission.summary.crashes, 0U);
    EXPECT_EQ(mission.summary.reader_losses, 0U);
    coverage.push_back(mission.coverage());
  }
  EXPECT_GE(median(coverage), 0.9);
}

TEST(SimAir, AMissionAtSlotLevelComesToWhatItComesToAtRoundLevel) {
  // A scene complete in itself. The models share world, policy and vehicle, not their draws: medians.
  Scene scene = test_scene("small");
  std::vector<double> coverage[2];
  std::vector<double> reads_per_s[2];
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const AirModel model : {AirModel::round, AirModel::slot}) {
      scene.world.air.model = model;
      const FlownMission mission = fly(scene, {.seed = seed});
      const std::size_t i = model == AirModel::slot ? 1 : 0;
      coverage[i].push_back(mission.coverage());
      reads_per_s[i].push_back(static_cast<double>(mission.summary.reads) / mission.summary.sim_time_s);
    }
  EXPECT_NEAR(median(coverage[1]), median(coverage[0]), 0.03);
  EXPECT_NEAR(median(reads_per_s[1]) / median(reads_per_s[0]), 1.0, 0.25);
}

TEST(SimAir, TheSceneDecidesTheModel) {
  Scene scene = test_scene("small");
  const mocks::World world;
  struct NoBody final : mocks::TrueBody {
    mocks::BodyState body;
    [[nodiscard]] const mocks::BodyState& state() const override { return body; }
  } body;
  EXPECT_NE(dynamic_cast<mocks::SimTagField*>(make_field(scene, world, body, 1).get()), nullptr);
  scene.world.air.model = AirModel::slot;
  EXPECT_NE(dynamic_cast<mocks::SlotTagField*>(make_field(scene, world, body, 1).get()), nullptr);
}

TEST(SimAir, TheRoundLevelTakesItsTimesFromTheLink) {
  Scene scene = test_scene("small");
  const mocks::AirParameters slow = air_of(scene);
  scene.world.air.tari_us = 6.25;
  scene.world.air.pie = 1.5;
  scene.world.air.blf_khz = 640.0;
  scene.world.air.m = 1;
  const mocks::AirParameters fast = air_of(scene);
  EXPECT_LT(fast.singulation_s, 0.2 * slow.singulation_s);
  EXPECT_LT(fast.round_s, slow.round_s);
  scene.world.radio.singulation_s = 0.002;
  EXPECT_EQ(air_of(scene).singulation_s, 0.002) << "unless the scene says so";
  scene.world.air.dwell_s = 0.25;
  EXPECT_EQ(air_of(scene).max_dwell_s, 0.25);
  EXPECT_EQ(air_of(scene).patience_log_sigma, 0.0);
}

TEST(SimAir, RefusesALinkNoReaderMayUseAndNamesTheFile) {
  Scene scene = test_scene("small");
  EXPECT_TRUE(check_air(scene));
  scene.world.air.blf_khz = 640.0;  // with Tari 25
  const auto refused = check_air(scene);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().device.find("small.toml"), std::string::npos);
  EXPECT_NE(refused.error().detail.find("TRcal"), std::string::npos);
  scene = test_scene("small");
  scene.world.air.dwell_s = 0.02;
  scene.world.air.round_overhead_s = 0.05;
  EXPECT_FALSE(check_air(scene)) << "no read fits into such a visit";
}

}  // namespace
}  // namespace forager::boards
