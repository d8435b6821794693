#include "servo/motion_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

hal::PoseSample sample(Instant at, double x, double y, double yaw) {
  hal::PoseSample s;
  s.stamp = at;
  s.pose.position = {x, y, 0.0};
  s.pose.yaw_rad = yaw;
  return s;
}

// Drives straight at 0.5 m/s under a heading, seen at 30 Hz with noise.
TEST(MotionEstimate, FindsTheSpeedBehindNoisyPoses) {
  MotionEstimate estimate({});
  hal::Random random(5);
  const double yaw = 2.0;
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Instant now{i * 10ms};
    estimate.predict(now, 0.0, 0.0);
    const double way = 0.5 * hal::to_seconds(now);
    if (i % 3 == 0) {
      EXPECT_TRUE(estimate.take(sample(now, way * std::cos(yaw) + 0.005 * random.normal(),
                                       way * std::sin(yaw) + 0.005 * random.normal(), yaw)));
    }
    if (i > 100) worst = std::max(worst, std::abs(estimate.speed_m_s() - 0.5));
  }
  EXPECT_LT(worst, 0.1);
  EXPECT_NEAR(estimate.pose().position.x, 0.5 * 2.99 * std::cos(yaw), 0.02);
}

TEST(MotionEstimate, CarriesOnThroughAGap) {
  MotionEstimate estimate({});
  for (int i = 0; i <= 100; ++i) {
    const Instant now{i * 10ms};
    estimate.predict(now, 0.0, 0.0);
    if (i <= 80 && i % 3 == 0) {
      EXPECT_TRUE(estimate.take(sample(now, 0.4 * hal::to_seconds(now), 0.0, 0.0)));
    }
  }
  EXPECT_NEAR(estimate.pose().position.x, 0.4, 0.01);
  EXPECT_GT(estimate.pose_age(Instant{1s}), 200ms);
}

TEST(MotionEstimate, ComparesALatePoseWithWhereItWasThen) {
  MotionEstimate estimate({});
  for (int i = 0; i <= 200; ++i) {
    const Instant now{i * 10ms};
    estimate.predict(now, 0.0, 0.0);
    const Instant then = now - 60ms;
    if (i >= 6 && i % 3 == 0) {
      EXPECT_TRUE(estimate.take(sample(then, 0.5 * hal::to_seconds(then), 0.0, 0.0)));
    }
  }
  EXPECT_NEAR(estimate.pose().position.x, 0.5 * 2.0, 0.01) << "not 3 cm behind";
}

TEST(MotionEstimate, TurnsByTheGyroBetweenPoses) {
  MotionEstimate estimate({});
  EXPECT_TRUE(estimate.take(sample(Instant{}, 0.0, 0.0, 3.0)));
  for (int i = 1; i <= 50; ++i) {
    estimate.predict(Instant{i * 10ms}, 0.0, 0.0);
    estimate.take_yaw_rate(0.8);
  }
  EXPECT_NEAR(estimate.yaw_rate_rad_s(), 0.8, 0.02);
  EXPECT_NEAR(estimate.pose().yaw_rad, hal::wrap_pi(3.0 + 0.4), 0.03) << "across the wrap";
}

TEST(MotionEstimate, TakesNothingItCannotUse) {
  MotionEstimate estimate({});
  EXPECT_FALSE(estimate.take(sample(Instant{1s}, std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0)));
  hal::PoseSample lost = sample(Instant{1s}, 0.0, 0.0, 0.0);
  lost.confidence = hal::PoseConfidence::failed;
  EXPECT_FALSE(estimate.take(lost));
  EXPECT_FALSE(estimate.known());
  EXPECT_TRUE(estimate.take(sample(Instant{1s}, 1.0, 0.0, 0.0)));
  EXPECT_FALSE(estimate.take(sample(Instant{1s}, 2.0, 0.0, 0.0))) << "not newer";
  estimate.take_yaw_rate(std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isfinite(estimate.yaw_rate_rad_s()));
}

TEST(MotionEstimate, APoseOfTheFutureIsNoPose) {
  MotionEstimate estimate({});
  estimate.predict(Instant{1s}, 0.0, 0.0);
  EXPECT_FALSE(estimate.take(sample(Instant{6s}, 1.0, 0.0, 0.0)));
  EXPECT_TRUE(estimate.take(sample(Instant{1s}, 1.0, 0.0, 0.0))) << "and does not make the next one old";
  EXPECT_EQ(estimate.pose_age(Instant{1s + 20ms}), 20ms);
  EXPECT_EQ(estimate.pose_age(Instant{500ms}), hal::Duration::max()) << "a clock that went back";
}

TEST(MotionEstimate, StartsAnewWhereTheSourceRelocalised) {
  MotionEstimate estimate({});
  EXPECT_TRUE(estimate.take(sample(Instant{1s}, 0.0, 0.0, 0.0)));
  estimate.predict(Instant{1s + 30ms}, 0.0, 0.0);
  hal::PoseSample moved = sample(Instant{1s + 30ms}, 3.0, 1.0, 0.5);
  moved.reset_counter = 1;
  EXPECT_TRUE(estimate.take(moved));
  EXPECT_EQ(estimate.resets(), 1U);
  EXPECT_EQ(estimate.pose().position.x, 3.0);
  EXPECT_EQ(estimate.speed_m_s(), 0.0) << "a jump is not a motion";
}

}  // namespace
}  // namespace forager::servo
