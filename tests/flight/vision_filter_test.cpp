#include "flight/vision_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

// A source at 200 Hz; the filter passes at most one sample in 30 ms.
class VisionFilterTest : public ::testing::Test {
 protected:
  static VisionFilterConfig config() {
    VisionFilterConfig config;
    config.min_interval = 30ms;
    return config;
  }

  std::optional<hal::PoseSample> see(hal::Vec3 position, double yaw_rad = 0.0) {
    now_ += 5ms;
    hal::PoseSample sample;
    sample.stamp = now_;
    sample.pose.position = position;
    sample.pose.yaw_rad = yaw_rad;
    sample.confidence = confidence_;
    sample.reset_counter = source_counter_;
    return filter_.update(sample, now_);
  }

  // What was passed on while the source stays at a place for `samples`.
  std::vector<hal::PoseSample> stay(hal::Vec3 position, int samples) {
    std::vector<hal::PoseSample> passed;
    for (int i = 0; i < samples; ++i)
      if (const auto sample = see(position)) passed.push_back(*sample);
    return passed;
  }

  hal::Instant now_{};
  hal::PoseConfidence confidence_ = hal::PoseConfidence::high;
  std::uint8_t source_counter_ = 0;
  VisionFilter filter_{config()};
};

TEST_F(VisionFilterTest, ThinsAFastSourceToItsRate) {
  EXPECT_EQ(stay({0, 0, 1}, 200).size(), 34U);  // 1 s
  EXPECT_EQ(filter_.stats().thinned, 166U);
  EXPECT_EQ(filter_.stats().jumps, 0U);
}

TEST_F(VisionFilterTest, FollowsAVehicleAtItsTopSpeed) {
  for (int i = 0; i < 400; ++i)
    (void)see({0.01 * i, 0, 1}, hal::wrap_pi(0.0099 * i));  // 2 m/s, turning through pi
  EXPECT_EQ(filter_.stats().jumps, 0U);
  EXPECT_EQ(filter_.stats().resets, 0U);
}

TEST_F(VisionFilterTest, DropsSingleOutliers) {
  stay({0, 0, 1}, 20);
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(see({0.6, 0, 1}));
    EXPECT_EQ(filter_.health(now_), VisionHealth::good) << "the sample before is still fresh";
    for (const auto& sample : stay({0, 0, 1}, 9)) {
      EXPECT_EQ(sample.pose.position.x, 0.0);
      EXPECT_EQ(sample.reset_counter, 0);
    }
  }
  EXPECT_EQ(filter_.stats().jumps, 20U);
}

TEST_F(VisionFilterTest, DropsJumpsOfYaw) {
  stay({0, 0, 1}, 20);
  EXPECT_FALSE(see({0, 0, 1}, 0.5));
  EXPECT_EQ(filter_.stats().jumps, 1U);
}

TEST_F(VisionFilterTest, APersistentJumpBecomesOneResetAndIsNeverPassedUnmarked) {
  stay({0, 0, 1}, 20);
  const auto after = stay({0.6, 0, 1}, 100);  // 0.5 s
  ASSERT_FALSE(after.empty());
  for (const auto& sample : after) EXPECT_EQ(sample.reset_counter, 1);
  EXPECT_EQ(filter_.stats().resets, 1U);
  EXPECT_EQ(filter_.stats().jumps, 60U) << "300 ms at 200 Hz";
  EXPECT_EQ(filter_.health(now_), VisionHealth::good);
}

TEST_F(VisionFilterTest, AJumpTheVehicleCouldMakeInTheMeantimeIsStillAJump) {
  // 0.25 m is soon within reach at 2 m/s, were the time since the last good sample to count.
  stay({0, 0, 1}, 20);
  for (const auto& sample : stay({0.25, 0, 1}, 100)) EXPECT_EQ(sample.reset_counter, 1);
}

TEST_F(VisionFilterTest, AShortExcursionLeavesNoTrace) {
  stay({0, 0, 1}, 20);
  EXPECT_TRUE(stay({3, 0, 1}, 40).empty());  // 200 ms
  for (const auto& sample : stay({0, 0, 1}, 20)) EXPECT_EQ(sample.reset_counter, 0);
  EXPECT_EQ(filter_.stats().resets, 0U);
}

TEST_F(VisionFilterTest, WildSamplesNeverBecomeAReset) {
  stay({0, 0, 1}, 20);
  for (int i = 0; i < 400; ++i) EXPECT_FALSE(see({(i % 2 == 0 ? 3.0 : -3.0), 0.0, 1.0}));
  EXPECT_EQ(filter_.stats().resets, 0U);
  EXPECT_EQ(filter_.health(now_), VisionHealth::jumping);
}

TEST_F(VisionFilterTest, ASourceThatSaysItResetIsBelievedAtOnce) {
  stay({0, 0, 1}, 20);
  source_counter_ = 7;
  const auto after = stay({5, 5, 1}, 10);
  ASSERT_FALSE(after.empty());
  for (const auto& sample : after) EXPECT_EQ(sample.reset_counter, 1);
  EXPECT_EQ(filter_.stats().jumps, 0U);
}

TEST_F(VisionFilterTest, AJumpAcrossASilenceIsNotExcusedByIt) {
  stay({0, 0, 1}, 20);
  now_ += 5s;
  EXPECT_FALSE(see({3, 0, 1})) << "5 s x 2 m/s would allow it";
  EXPECT_EQ(filter_.stats().jumps, 1U);
}

TEST_F(VisionFilterTest, LowConfidenceIsDroppedAndTold) {
  EXPECT_EQ(filter_.health(now_), VisionHealth::waiting);
  stay({0, 0, 1}, 20);
  EXPECT_EQ(filter_.health(now_), VisionHealth::good);
  confidence_ = hal::PoseConfidence::failed;
  EXPECT_TRUE(stay({0, 0, 1}, 80).empty());
  EXPECT_EQ(filter_.health(now_), VisionHealth::low_confidence);
  EXPECT_EQ(filter_.stats().low_confidence, 80U);
}

TEST_F(VisionFilterTest, SilenceIsStale) {
  stay({0, 0, 1}, 20);
  EXPECT_EQ(filter_.health(now_ + 299ms), VisionHealth::good);
  EXPECT_EQ(filter_.health(now_ + 300ms), VisionHealth::stale);
}

TEST_F(VisionFilterTest, NeverPassesWhatIsNotANumberOrNotNewer) {
  stay({0, 0, 1}, 20);
  EXPECT_FALSE(see({std::nan(""), 0, 1}));
  EXPECT_FALSE(see({0, 0, 1}, std::numeric_limits<double>::infinity()));
  now_ -= 20ms;
  EXPECT_FALSE(see({0, 0, 1}));
  EXPECT_EQ(filter_.stats().unusable, 3U);
}

// One sample of the future must neither blind the filter for what comes nor keep it good meanwhile.
TEST_F(VisionFilterTest, AStampThatHasNotComeYetIsDropped) {
  stay({0, 0, 1}, 20);
  hal::PoseSample ahead;
  ahead.stamp = now_ + 5s;
  ahead.pose.position = {0, 0, 1};
  EXPECT_FALSE(filter_.update(ahead, now_));
  EXPECT_EQ(filter_.stats().unusable, 1U);
  EXPECT_FALSE(stay({0, 0, 1}, 20).empty()) << "the next true one counts";
  EXPECT_EQ(filter_.health(now_ + 300ms), VisionHealth::stale);
}

TEST_F(VisionFilterTest, AStampALittleAheadIsAClockThatIsALittleOff) {
  hal::PoseSample ahead;
  ahead.stamp = now_ + 50ms;
  EXPECT_TRUE(filter_.update(ahead, now_));
}

TEST(VisionFilterMount, PassesTheBodyNotTheCamera) {
  VisionFilterConfig config;
  config.camera_on_body = {{0.1, 0.0, -0.05}, 0.0, hal::kPi / 2, 0.0};  // looking down
  VisionFilter filter(config);
  hal::PoseSample sample;
  sample.pose = {{2.1, 3.0, 0.95}, 0.0, hal::kPi / 2, 0.0};
  const auto passed = filter.update(sample, sample.stamp);
  ASSERT_TRUE(passed);
  EXPECT_NEAR(passed->pose.position.x, 2.0, 1e-6);
  EXPECT_NEAR(passed->pose.position.y, 3.0, 1e-6);
  EXPECT_NEAR(passed->pose.position.z, 1.0, 1e-6);
  EXPECT_NEAR(passed->pose.pitch_rad, 0.0, 1e-6);
}

}  // namespace
}  // namespace forager::flight
