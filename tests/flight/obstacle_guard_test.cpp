#include "flight/obstacle_guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/flight/obstacle_guard_picture.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::Block;
using test::camera;
using test::kInf;
using test::kNaN;
using test::kNow;
using test::Picture;
using test::walls_config;

GuardVerdict look(const Picture& picture, const GuardConfig& config = walls_config(), double speed = 0.0,
                  double pitch = 0.0) {
  ObstacleGuard guard(config);
  const GuardVerdict metres = guard.check(picture.frame(), speed, pitch, kNow);
  const auto mm = picture.millimetres();
  const GuardVerdict millimetres =
      guard.check({kNow, picture.model, std::span<const std::uint16_t>(mm)}, speed, pitch, kNow);
  EXPECT_EQ(metres.way, millimetres.way) << "both pixel formats must agree";
  EXPECT_NEAR(metres.range_m, millimetres.range_m, 0.002);
  return metres;
}

const std::vector<Block> kAisle{{{-1, 1.75, -3}, {9, 2.35, 3}}, {{-1, -2.35, -3}, {9, -1.75, 3}}};

TEST(ObstacleGuard, NothingMeasuredIsBlind) {
  Picture picture;
  picture.fill(kNaN);
  EXPECT_EQ(look(picture).way, WayAhead::blind);
  EXPECT_EQ(look(picture).valid_pixels, 0U);
  picture.fill(0.0F);
  EXPECT_EQ(look(picture).way, WayAhead::blind);
  picture.fill(kInf);
  EXPECT_EQ(look(picture).way, WayAhead::blind);
  picture.fill(-1.0F);
  EXPECT_EQ(look(picture).way, WayAhead::blind);
  const std::vector<std::uint16_t> saturated(picture.metres.size(), 65535);
  ObstacleGuard guard(walls_config());
  EXPECT_EQ(guard.check({kNow, picture.model, std::span<const std::uint16_t>(saturated)}, 0, 0, kNow).way,
            WayAhead::blind);
}

TEST(ObstacleGuard, FreeToTheSensorsReachIsClear) {
  Picture picture;
  picture.fill(7.0F);
  const GuardVerdict verdict = look(picture);
  EXPECT_EQ(verdict.way, WayAhead::clear);
  EXPECT_DOUBLE_EQ(verdict.range_m, 7.0);
  EXPECT_EQ(verdict.valid_pixels, verdict.window_pixels);
}

TEST(ObstacleGuard, OneUnknownOrWildPixelChangesNothing) {
  Picture picture;
  picture.fill(7.0F);
  const std::size_t centre = picture.metres.size() / 2 + 80;
  for (const float wild : {0.0F, kNaN, kInf, -3.0F, 0.05F, 0.5F}) {
    picture.metres[centre] = wild;
    EXPECT_EQ(look(picture).way, WayAhead::clear) << wild;
  }
}

TEST(ObstacleGuard, ShelvesAtBothSidesLeaveTheAisleClear) {
  Picture picture;
  picture.render(kAisle);
  EXPECT_LT(*std::min_element(picture.metres.begin(), picture.metres.end()), 2.0F)
      << "the shelves are in view";
  EXPECT_EQ(look(picture).way, WayAhead::clear);
}

TEST(ObstacleGuard, FloorAndCeilingLeaveTheWayClear) {
  Picture picture;
  picture.render({{{-9, -9, -1.3}, {9, 9, -0.9}}, {{-9, -9, 0.9}, {9, 9, 1.5}}});
  EXPECT_LT(*std::min_element(picture.metres.begin(), picture.metres.end()), 2.0F);
  EXPECT_EQ(look(picture).way, WayAhead::clear);
}

TEST(ObstacleGuard, SmallBoxAheadBlocks) {
  Picture picture;
  auto blocks = kAisle;
  blocks.push_back({{1.5, -0.15, -0.15}, {1.8, 0.15, 0.15}});
  picture.render(blocks);
  const GuardVerdict verdict = look(picture);
  EXPECT_EQ(verdict.way, WayAhead::blocked);
  EXPECT_NEAR(verdict.range_m, 1.5, 0.01);
}

TEST(ObstacleGuard, BoxBesideOrAboveTheCorridorDoesNotBlock) {
  Picture picture;
  picture.render({{{1.5, 0.85, -0.15}, {1.8, 1.15, 0.15}}});
  EXPECT_EQ(look(picture).way, WayAhead::clear);
  picture.render({{{1.5, -0.15, 0.5}, {1.8, 0.15, 0.8}}});
  EXPECT_EQ(look(picture).way, WayAhead::clear);
  picture.render({{{1.5, 0.7, -0.15}, {1.8, 1.0, 0.15}}});
  EXPECT_EQ(look(picture).way, WayAhead::blocked) << "its edge reaches into the corridor";
}

TEST(ObstacleGuard, ShelfAcrossTheWayBlocksNearerThanDOnly) {
  Picture picture;
  for (const double at : {0.3, 1.0, 1.75, 1.98}) {
    picture.render({{{at, -9, -3}, {at + 0.5, 9, 3}}});
    EXPECT_EQ(look(picture).way, WayAhead::blocked) << at;
  }
  for (const double at : {2.05, 3.0, 6.9}) {
    picture.render({{{at, -9, -3}, {at + 0.5, 9, 3}}});
    EXPECT_EQ(look(picture).way, WayAhead::clear) << at;
    EXPECT_NEAR(look(picture).range_m, at, 0.01);
  }
}

TEST(ObstacleGuard, SpeedAsksForMoreRoom) {
  ObstacleGuard guard(walls_config());
  EXPECT_DOUBLE_EQ(guard.required_distance_m(0.0), 2.0);
  EXPECT_DOUBLE_EQ(guard.required_distance_m(-4.0), 2.0);
  EXPECT_DOUBLE_EQ(guard.required_distance_m(3.0), 9.0 / 3.0 + 3.0 * 0.4 + 0.5);
  Picture picture;
  picture.render({{{3.0, -9, -3}, {3.5, 9, 3}}});
  EXPECT_EQ(look(picture, walls_config(), 1.0).way, WayAhead::clear);
  EXPECT_EQ(look(picture, walls_config(), 3.0).way, WayAhead::blocked);
  EXPECT_EQ(look(picture, walls_config(), 9.0).way, WayAhead::blind) << "cannot stop within what it sees";
  EXPECT_EQ(look(picture, walls_config(), std::nan("")).way, WayAhead::blind);
}

TEST(ObstacleGuard, PitchIsTakenOutOfTheHeightBand) {
  GuardConfig config = walls_config();
  Picture picture;
  const std::vector<Block> floor{{{-9, -9, -1.0}, {9, 9, -0.8}}};
  picture.render(floor, hal::deg_to_rad(20.0));
  EXPECT_EQ(look(picture, config, 0.0, hal::deg_to_rad(20.0)).way, WayAhead::clear);
  EXPECT_EQ(look(picture, config, 0.0, 0.0).way, WayAhead::blocked) << "taken for level it sees the floor";
  picture.render({{{1.5, -0.15, -0.15}, {1.8, 0.15, 0.15}}}, hal::deg_to_rad(20.0));
  EXPECT_EQ(look(picture, config, 0.0, hal::deg_to_rad(20.0)).way, WayAhead::blocked);
}

TEST(ObstacleGuard, QuotaCountsOnlyPixelsThatLookThroughTheCorridor) {
  Picture picture;
  picture.fill(0.0F);
  for (int row = 0; row < picture.model.rows; ++row)
    for (int column = 40; column < 120; ++column)
      picture.metres[static_cast<std::size_t>(row * 160 + column)] = 7.0F;
  EXPECT_EQ(look(picture).way, WayAhead::clear) << "what is unknown beside the corridor does not matter";
  picture.fill(7.0F);
  for (int row = 0; row < picture.model.rows; ++row)
    for (int column = 40; column < 120; ++column)
      if ((row + column) % 5 != 0) picture.metres[static_cast<std::size_t>(row * 160 + column)] = 0.0F;
  const GuardVerdict verdict = look(picture);
  EXPECT_EQ(verdict.way, WayAhead::blind);
  EXPECT_EQ(verdict.reason, "few valid pixels");
  EXPECT_DOUBLE_EQ(verdict.range_m, 0.0);
}

TEST(ObstacleGuard, OddImagesAreJudgedAlike) {
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 7}, {7, 1}, {33, 17}, {161, 121}}) {
    Picture picture;
    picture.model = camera(columns, rows);
    GuardConfig config = walls_config();
    config.nearest = 1;
    picture.fill(7.0F);
    EXPECT_EQ(look(picture, config).way, WayAhead::clear) << columns << "x" << rows;
    picture.fill(1.0F);
    EXPECT_EQ(look(picture, config).way, WayAhead::blocked) << columns << "x" << rows;
    picture.fill(kNaN);
    EXPECT_EQ(look(picture, config).way, WayAhead::blind) << columns << "x" << rows;
  }
}

TEST(ObstacleGuard, UnusableFramesAreBlind) {
  ObstacleGuard guard(walls_config());
  Picture picture;
  picture.fill(7.0F);
  EXPECT_EQ(guard.latest(kNow).way, WayAhead::blind) << "no frame yet";
  hal::DepthFrame frame = picture.frame();
  frame.camera.rows += 1;
  EXPECT_EQ(guard.check(frame, 0, 0, kNow).way, WayAhead::blind) << "fewer pixels than the model says";
  frame = picture.frame();
  frame.camera.fx_px = 0.0;
  EXPECT_EQ(guard.check(frame, 0, 0, kNow).way, WayAhead::blind);
  frame = {};
  frame.stamp = kNow;
  EXPECT_EQ(guard.check(frame, 0, 0, kNow).way, WayAhead::blind);
  frame = picture.frame();
  frame.camera.cx_px = -5000.0;
  EXPECT_EQ(guard.check(frame, 0, 0, kNow).way, WayAhead::blind) << "looks past the corridor";
}

TEST(ObstacleGuard, OldFramesAreBlind) {
  ObstacleGuard guard(walls_config());
  Picture picture;
  picture.fill(7.0F);
  EXPECT_EQ(guard.check(picture.frame(kNow - 250ms), 0, 0, kNow).way, WayAhead::clear);
  EXPECT_EQ(guard.latest(kNow + 50ms).way, WayAhead::clear);
  EXPECT_EQ(guard.latest(kNow + 51ms).way, WayAhead::blind);
  EXPECT_EQ(guard.check(picture.frame(kNow - 301ms), 0, 0, kNow).way, WayAhead::blind);
  EXPECT_EQ(guard.check(picture.frame(kNow + 301ms), 0, 0, kNow).way, WayAhead::blind);
}

}  // namespace
}  // namespace forager::flight
