#include "mocks/ray_cast_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Instant;
using hal::Vec3;

struct FixedBody final : TrueBody {
  BodyState body;
  [[nodiscard]] const BodyState& state() const override { return body; }
};

class SimDepthCameraTest : public ::testing::Test {
 protected:
  SimDepthCameraTest() {
    options_.metres = true;
    body_.body.pose.position = {0.0, 0.0, 1.5};
  }

  // Every pixel of one frame, metres, 0 = unknown.
  std::vector<float> picture() {
    SimDepthCamera camera(world_, body_, options_, 7);
    model_ = camera.model();
    const auto frame = camera.poll(Instant{});
    const auto pixels = std::get<std::span<const float>>((*frame)->pixels);
    return {pixels.begin(), pixels.end()};
  }

  // A second way to the same number: the depth of the nearest surface along one ray, by the slab test.
  [[nodiscard]] double traced(int row, int column) const {
    const hal::Pose& pose = body_.body.pose;
    const Vec3 ray_camera{1.0, (model_.cx_px - (column + 0.5)) / model_.fx_px,
                          (model_.cy_px - (row + 0.5)) / model_.fy_px};
    const Vec3 rolled{ray_camera.x,
                      ray_camera.y * std::cos(pose.roll_rad) - ray_camera.z * std::sin(pose.roll_rad),
                      ray_camera.y * std::sin(pose.roll_rad) + ray_camera.z * std::cos(pose.roll_rad)};
    const Vec3 pitched{rolled.x * std::cos(pose.pitch_rad) + rolled.z * std::sin(pose.pitch_rad), rolled.y,
                       -rolled.x * std::sin(pose.pitch_rad) + rolled.z * std::cos(pose.pitch_rad)};
    const Vec3 ray = hal::rotate_yaw(pitched, pose.yaw_rad);
    double nearest = ray.z < 0.0 ? -pose.position.z / ray.z : HUGE_VAL;
    for (const Box& box : world_.obstacles) {
      double enter = 0.0;
      double leave = HUGE_VAL;
      const auto slab = [&](double from, double along, double low, double high) {
        const double a = (low - from) / along;
        const double b = (high - from) / along;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      };
      slab(pose.position.x, ray.x, box.min.x, box.max.x);
      slab(pose.position.y, ray.y, box.min.y, box.max.y);
      slab(pose.position.z, ray.z, box.min.z, box.max.z);
      if (enter <= leave) nearest = std::min(nearest, enter);
    }
    return nearest >= options_.min_m && nearest <= options_.max_m ? nearest : 0.0;
  }

  [[nodiscard]] std::size_t at(int row, int column) const {
    return static_cast<std::size_t>(row * model_.columns + column);
  }

  World world_;
  FixedBody body_;
  SimDepthOptions options_;
  hal::DepthCameraModel model_;
};

TEST_F(SimDepthCameraTest, AWallAcrossTheViewIsEquallyDeepEverywhere) {
  world_.obstacles.push_back({{3.0, -50.0, -1.0}, {3.2, 50.0, 50.0}});
  body_.body.pose.position.z = 2.5;
  const auto pixels = picture();
  // Depth is along the axis, so the corners are no farther than the middle.
  for (const float depth : pixels) ASSERT_NEAR(depth, 3.0, 1e-5);
}

TEST_F(SimDepthCameraTest, TheFloorRisesTowardsTheHorizon) {
  const auto pixels = picture();
  for (int row = 0; row < model_.rows; ++row) {
    const double down = (row + 0.5 - model_.cy_px) / model_.fy_px;
    const double depth = down > 0.0 ? 1.5 / down : 0.0;
    EXPECT_NEAR(pixels[at(row, 17)], depth <= options_.max_m ? depth : 0.0, 1e-5) << row;
  }
}

TEST_F(SimDepthCameraTest, AnAisleBoxHidesWhatIsBehindItAndNothingElse) {
  world_.obstacles.push_back({{1.5, -0.15, 1.35}, {1.8, 0.15, 1.65}});
  world_.obstacles.push_back({{5.0, -9.0, 0.0}, {5.5, 9.0, 4.0}});
  const auto pixels = picture();
  EXPECT_NEAR(pixels[at(30, 40)], 1.5, 1e-5);
  EXPECT_NEAR(pixels[at(30, 5)], 5.0, 1e-5);
  // 0.3 m at 1.5 m is 0.2 of the focal length in pixels wide: 8.4 columns.
  const auto seen =
      std::count_if(pixels.begin() + 30 * 80, pixels.begin() + 31 * 80, [](float d) { return d < 2.0F; });
  EXPECT_EQ(seen, 8);
}

TEST_F(SimDepthCameraTest, AgreesWithATracedRayAtEveryPixelUnderAnyAttitude) {
  hal::Random random(11);
  for (int trial = 0; trial < 40; ++trial) {
    world_.obstacles.clear();
    for (int i = 0; i < 12; ++i) {
      const Vec3 low{random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0), random.uniform(0.0, 2.0)};
      world_.obstacles.push_back(
          {low, low + Vec3{random.uniform(0.1, 2.0), random.uniform(0.1, 2.0), random.uniform(0.1, 2.0)}});
    }
    body_.body.pose = {{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.3, 2.5)},
                       random.uniform(-3.0, 3.0),
                       random.uniform(-0.5, 0.5),
                       random.uniform(-0.5, 0.5)};
    const Vec3 eye = body_.body.pose.position;
    std::erase_if(world_.obstacles, [&](const Box& b) {
      return eye.x > b.min.x && eye.x < b.max.x && eye.y > b.min.y && eye.y < b.max.y && eye.z > b.min.z &&
             eye.z < b.max.z;
    });
    const auto pixels = picture();
    int different = 0;
    for (int row = 0; row < model_.rows; ++row)
      for (int column = 0; column < model_.columns; ++column)
        if (std::abs(pixels[at(row, column)] - traced(row, column)) > 1e-4) ++different;
    // A pixel centre may lie on an edge to the last bit.
    EXPECT_LE(different, 1) << trial;
  }
}

TEST_F(SimDepthCameraTest, OutOfRangeAndCoveredLensAreUnknown) {
  world_.obstacles.push_back({{0.05, -5.0, 0.0}, {0.1, 5.0, 5.0}});
  for (const float depth : picture()) ASSERT_EQ(depth, 0.0F);
  world_.obstacles[0] = {{-1.0, -1.0, 0.0}, {1.0, 1.0, 3.0}};
  for (const float depth : picture()) ASSERT_EQ(depth, 0.0F);
}

TEST_F(SimDepthCameraTest, MountingMovesAndTurnsTheLens) {
  world_.obstacles.push_back({{-9.0, 4.0, 0.0}, {9.0, 4.5, 4.0}});
  options_.mounting.position = {0.0, 0.3, 0.0};
  options_.mounting.yaw_rad = hal::kPi / 2.0;
  EXPECT_NEAR(picture()[at(30, 40)], 3.7, 1e-5);
}

TEST_F(SimDepthCameraTest, MillimetresAreRoundedAndACeilingIsSeen) {
  options_.metres = false;
  options_.ceiling_m = 2.0;
  world_.obstacles.push_back({{3.0004, -50.0, 0.0}, {3.2, 50.0, 5.0}});
  SimDepthCamera camera(world_, body_, options_, 1);
  const auto frame = camera.poll(Instant{});
  const auto pixels = std::get<std::span<const std::uint16_t>>((*frame)->pixels);
  EXPECT_EQ(pixels[30 * 80 + 40], 3000);
  EXPECT_EQ(pixels[40], static_cast<int>(std::lround(500.0 / (29.5 / camera.model().fy_px))));
}

TEST_F(SimDepthCameraTest, KeepsItsFrameRateWhateverThePolling) {
  SimDepthCamera camera(world_, body_, options_, 1);
  int frames = 0;
  for (Instant now{}; now < Instant{} + 10s; now += 7ms)
    if (*camera.poll(now)) ++frames;
  EXPECT_EQ(frames, 100);
  EXPECT_FALSE(*camera.poll(Instant{} + 10s - 1ms));
}

TEST_F(SimDepthCameraTest, LatencyDeliversThePastAndStampsIt) {
  options_.latency = 60ms;
  world_.obstacles.push_back({{3.0, -9.0, 0.0}, {3.5, 9.0, 4.0}});
  SimDepthCamera camera(world_, body_, options_, 1);
  EXPECT_FALSE(*camera.poll(Instant{}));
  body_.body.pose.position.x = 1.0;
  EXPECT_FALSE(*camera.poll(Instant{} + 40ms));
  const auto frame = camera.poll(Instant{} + 60ms);
  ASSERT_TRUE(*frame);
  EXPECT_EQ((*frame)->stamp, Instant{});
  EXPECT_NEAR(std::get<std::span<const float>>((*frame)->pixels)[30 * 80 + 40], 3.0, 1e-5);
}

TEST_F(SimDepthCameraTest, NoiseGrowsWithTheSquareOfDepth) {
  options_.noise_per_m = 0.002;
  for (const double distance : {2.0, 5.0}) {
    world_.obstacles.assign(1, {{distance, -50.0, -1.0}, {distance + 0.1, 50.0, 50.0}});
    body_.body.pose.position.z = 4.0;
    const auto pixels = picture();
    double sum = 0.0;
    for (const float d : pixels) sum += (d - distance) * (d - distance);
    const double expected = 0.002 * distance * distance;
    // 4800 pixels give the deviation to 1 %; the quadratic law is good to a few per cent.
    EXPECT_NEAR(std::sqrt(sum / static_cast<double>(pixels.size())), expected, 0.06 * expected);
  }
}

TEST_F(SimDepthCameraTest, LosesTheSharesOfPixelsItWasToldTo) {
  world_.obstacles.push_back({{3.0, -50.0, -1.0}, {3.2, 50.0, 50.0}});
  body_.body.pose.position.z = 4.0;
  options_.speckle_share = 0.1;
  options_.dead_share = 0.05;
  const auto pixels = picture();
  const auto lost = std::count(pixels.begin(), pixels.end(), 0.0F);
  EXPECT_NEAR(static_cast<double>(lost) / 4800.0, 0.145, 0.025);
}

TEST_F(SimDepthCameraTest, NothingWithinReachIsUnknownOrTheMaximum) {
  SimDepthOptions options = options_;
  options.noise_per_m = 0.01;
  const auto ahead = [&](SimDepthCamera& camera, Instant now) {
    const auto frame = camera.poll(now);
    return std::get<std::span<const float>>((*frame)->pixels)[20 * 80 + 40];
  };
  SimDepthCamera bare(world_, body_, options, 1);
  EXPECT_EQ(ahead(bare, Instant{}), 0.0F);
  options.far_as_max = true;
  SimDepthCamera filled(world_, body_, options, 1);
  EXPECT_NEAR(ahead(filled, Instant{}), options.max_m, 1e-4);
  filled.set_fault(DepthFault::blind);
  EXPECT_EQ(ahead(filled, Instant{} + 100ms), 0.0F);
  filled.set_fault(DepthFault::none);
  world_.obstacles.push_back({{-1.0, -1.0, 0.0}, {1.0, 1.0, 4.0}});
  EXPECT_EQ(ahead(filled, Instant{} + 200ms), 0.0F) << "a covered lens sees nothing";
}

TEST_F(SimDepthCameraTest, FaultsLookLikeTheirCause) {
  world_.obstacles.push_back({{3.0, -9.0, 0.0}, {3.5, 9.0, 4.0}});
  SimDepthCamera camera(world_, body_, options_, 1);
  const auto middle = [&](Instant now) {
    const auto frame = camera.poll(now);
    return std::get<std::span<const float>>((*frame)->pixels)[30 * 80 + 40];
  };
  EXPECT_NEAR(middle(Instant{}), 3.0, 1e-5);
  camera.set_fault(DepthFault::freeze);
  body_.body.pose.position.x = 1.0;
  EXPECT_NEAR(middle(Instant{} + 100ms), 3.0, 1e-5);
  camera.set_fault(DepthFault::none);
  EXPECT_NEAR(middle(Instant{} + 200ms), 2.0, 1e-5);
  camera.set_fault(DepthFault::blind);
  EXPECT_EQ(middle(Instant{} + 300ms), 0.0F);
  camera.set_fault(DepthFault::stall);
  EXPECT_FALSE(*camera.poll(Instant{} + 400ms));
  camera.set_fault(DepthFault::disconnect);
  const auto gone = camera.poll(Instant{} + 500ms);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, hal::ErrorCode::disconnected);
}

}  // namespace
}  // namespace forager::mocks
