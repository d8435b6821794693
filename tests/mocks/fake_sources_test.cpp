#include <gtest/gtest.h>

#include <array>

#include "mocks/fake_depth_source.hpp"
#include "mocks/fake_pose_source.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

const hal::Instant kStart{};

TEST(FakePoseSource, GivesTheNewestOnceAfterItsLatency) {
  FakePoseSource source;
  source.set_latency(20ms);
  hal::PoseSample sample;
  sample.stamp = kStart;
  sample.pose.yaw_rad = 1.0;
  source.show(sample);
  sample.stamp = kStart + 5ms;
  sample.pose.yaw_rad = 2.0;
  source.show(sample);
  EXPECT_FALSE(source.poll(kStart + 19ms).value().has_value());
  EXPECT_EQ(source.poll(kStart + 25ms).value()->pose.yaw_rad, 2.0);
  EXPECT_FALSE(source.poll(kStart + 26ms).value().has_value());
  source.disconnect();
  EXPECT_EQ(source.poll(kStart + 30ms).error().code, hal::ErrorCode::disconnected);
  source.disconnect(false);
  source.fail_next({hal::ErrorCode::io, "pose", "poll", "injected", "", 0});
  EXPECT_EQ(source.poll(kStart + 30ms).error().code, hal::ErrorCode::io);
  EXPECT_TRUE(source.poll(kStart + 30ms).has_value());
}

TEST(FakeDepthSource, KeepsItsOwnPixels) {
  FakeDepthSource source;
  hal::DepthCameraModel camera;
  camera.columns = 2;
  camera.rows = 1;
  std::array<std::uint16_t, 2> pixels{1500, 65535};
  source.show({kStart, camera, std::span<const std::uint16_t>(pixels)});
  pixels = {0, 0};
  const auto frame = source.poll(kStart).value();
  ASSERT_TRUE(frame.has_value());
  const auto shown = std::get<std::span<const std::uint16_t>>(frame->pixels);
  ASSERT_EQ(shown.size(), 2U);
  EXPECT_EQ(shown[0], 1500);
  EXPECT_EQ(shown[1], 65535);

  source.show_wall(kStart + 1s, camera, 2.5F);
  EXPECT_FALSE(source.poll(kStart).value().has_value());
  const auto wall = source.poll(kStart + 1s).value();
  ASSERT_TRUE(wall.has_value());
  EXPECT_EQ(std::get<std::span<const float>>(wall->pixels)[1], 2.5F);
}

}  // namespace
}  // namespace forager::mocks
