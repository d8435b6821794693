#include "flight/depth_sectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

// 90 by 60 pixels, 90 degrees across: bearings are easy to tell.
hal::DepthCameraModel camera() {
  hal::DepthCameraModel model;
  model.columns = 90;
  model.rows = 60;
  model.fx_px = 45.0;
  model.fy_px = 45.0;
  model.cx_px = 45.0;
  model.cy_px = 30.0;
  return model;
}

struct Picture {
  hal::DepthCameraModel model = camera();
  std::vector<float> metres = std::vector<float>(90 * 60, 7.0F);
  void put(int column, int row, float depth) { metres[static_cast<std::size_t>(row * 90 + column)] = depth; }
  [[nodiscard]] hal::DepthFrame frame() const { return {{}, model, std::span<const float>(metres)}; }
};

GuardConfig k_of(std::uint32_t k) {
  GuardConfig config;
  config.nearest = k;
  return config;
}

TEST(DepthSectors, GoFromLeftToRightOverTheWholeView) {
  const auto sectors = depth_sectors(Picture{}.frame(), k_of(1), 9);
  ASSERT_EQ(sectors.size(), 9U);
  EXPECT_NEAR(hal::rad_to_deg(sectors.front().left_rad), 45.0, 1e-9);
  EXPECT_NEAR(hal::rad_to_deg(sectors.back().right_rad), -45.0, 1e-9);
  std::uint32_t pixels = 0;
  for (std::size_t i = 0; i < sectors.size(); ++i) {
    pixels += sectors[i].pixels;
    EXPECT_EQ(sectors[i].valid, sectors[i].pixels);
    EXPECT_FALSE(sectors[i].nearest_m) << "the sensor's reach is no obstacle";
    if (i > 0) {
      EXPECT_EQ(sectors[i].left_rad, sectors[i - 1].right_rad);
    }
  }
  EXPECT_EQ(pixels, 5400U);
}

TEST(DepthSectors, SomethingOnTheLeftIsInALeftSector) {
  Picture picture;
  picture.put(2, 30, 1.5F);
  const auto sectors = depth_sectors(picture.frame(), k_of(1), 9);
  EXPECT_FLOAT_EQ(static_cast<float>(sectors[0].nearest_m.value()), 1.5F);
  EXPECT_FALSE(sectors[8].nearest_m);
}

TEST(DepthSectors, TheKthNearestDecides) {
  Picture picture;
  for (int i = 0; i < 4; ++i) picture.put(45, 28 + i, 1.0F + static_cast<float>(i));
  EXPECT_EQ(depth_sectors(picture.frame(), k_of(3), 9)[4].nearest_m, 3.0);
  EXPECT_EQ(depth_sectors(picture.frame(), k_of(4), 9)[4].nearest_m, 4.0);
  EXPECT_FALSE(depth_sectors(picture.frame(), k_of(5), 9)[4].nearest_m);
}

TEST(DepthSectors, FloorAndCeilingAreNotAtTheBodysHeight) {
  Picture picture;
  picture.put(45, 55, 2.0F);  // 2 m * 25.5 / 45 = 1.13 m below
  picture.put(46, 2, 2.0F);   // as far above
  EXPECT_FALSE(depth_sectors(picture.frame(), k_of(1), 9)[4].nearest_m);
}

TEST(DepthSectors, UnknownPixelsAreNeitherFreeNorNear) {
  Picture picture;
  for (float& value : picture.metres) value = std::numeric_limits<float>::quiet_NaN();
  picture.put(45, 30, 0.0F);
  picture.put(46, 30, 0.05F);  // nearer than the sensor measures
  const auto sectors = depth_sectors(picture.frame(), k_of(1), 9);
  EXPECT_EQ(sectors[4].valid, 0U);
  EXPECT_FALSE(sectors[4].nearest_m);
}

TEST(DepthSectors, MillimetresAndMetresGiveTheSame) {
  Picture picture;
  std::vector<std::uint16_t> millimetres(90 * 60, 7000);
  picture.put(80, 30, 2.5F);
  millimetres[30 * 90 + 80] = 2500;
  millimetres[0] = 65535;
  picture.put(0, 0, std::numeric_limits<float>::infinity());
  const auto a = depth_sectors(picture.frame(), k_of(1), 9);
  const auto b = depth_sectors({{}, picture.model, std::span<const std::uint16_t>(millimetres)}, k_of(1), 9);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].valid, b[i].valid);
    EXPECT_EQ(a[i].nearest_m, b[i].nearest_m);
  }
}

TEST(DepthSectors, AFrameThatDoesNotFitItsModelGivesNothing) {
  Picture picture;
  picture.metres.pop_back();
  EXPECT_TRUE(depth_sectors(picture.frame(), k_of(1), 9).empty());
  EXPECT_TRUE(depth_sectors(Picture{}.frame(), k_of(1), 0).empty());
  EXPECT_EQ(depth_sectors(Picture{}.frame(), k_of(1), 1000).size(), 90U);
}

}  // namespace
}  // namespace forager::flight
