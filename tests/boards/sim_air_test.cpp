#include "boards/sim_air.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"
#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

TEST(SimAir, ASceneFliesAtSlotLevelMuchAsAtRoundLevel) {
  // One seed of the T, one of the small aisle: the models share world, policy and vehicle, not their draws.
  for (Scene scene : {published_scene("4A"), test_scene("small")}) {
    SCOPED_TRACE(scene.name);
    const FlownMission round = fly(scene);
    scene.world.air.model = AirModel::slot;
    const FlownMission slot = fly(scene);
    EXPECT_EQ(slot.summary.end, flight::EndReason::no_new_tags) << slot.summary.detail;
    EXPECT_EQ(slot.summary.crashes, 0U);
    EXPECT_EQ(slot.summary.reader_losses, 0U);
    EXPECT_NEAR(slot.coverage(), round.coverage(), 0.04);
    const auto reads_per_s = [](const FlownMission& m) {
      return static_cast<double>(m.summary.reads) / m.summary.sim_time_s;
    };
    EXPECT_NEAR(reads_per_s(slot) / reads_per_s(round), 1.0, 0.25) << reads_per_s(slot);
  }
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
