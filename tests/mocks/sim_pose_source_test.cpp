#include "mocks/sim_pose_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Instant;
using hal::PoseConfidence;
using hal::PoseSample;

struct MovingBody final : TrueBody {
  BodyState body;
  [[nodiscard]] const BodyState& state() const override { return body; }
};

std::vector<PoseSample> run(SimPoseSource& source, Instant from, hal::Duration length,
                            hal::Duration step = 5ms) {
  std::vector<PoseSample> samples;
  for (Instant now = from; now < from + length; now += step)
    if (const auto sample = source.poll(now); sample && *sample) samples.push_back(**sample);
  return samples;
}

SimPoseOptions perfect() {
  SimPoseOptions options;
  options.position_noise_m = options.angle_noise_rad = 0.0;
  options.drift_m_per_sqrt_s = options.yaw_drift_rad_per_sqrt_s = 0.0;
  return options;
}

TEST(SimPoseSource, WithoutErrorsItIsTheTruthAtItsRate) {
  MovingBody body;
  body.body.pose = {{1.0, -2.0, 1.5}, 3.0, 0.1, -0.05};
  SimPoseSource source(body, perfect(), 1);
  const auto samples = run(source, Instant{}, 10s);
  EXPECT_EQ(samples.size(), 300U);
  EXPECT_EQ(samples.back().pose.position, body.body.pose.position);
  EXPECT_DOUBLE_EQ(samples.back().pose.yaw_rad, 3.0);
  EXPECT_DOUBLE_EQ(samples.back().pose.roll_rad, -0.05);
}

TEST(SimPoseSource, NoiseHasTheStatedSpread) {
  MovingBody body;
  SimPoseOptions options = perfect();
  options.position_noise_m = 0.002;
  options.angle_noise_rad = hal::deg_to_rad(0.1);
  SimPoseSource source(body, options, 3);
  double x2 = 0.0;
  double yaw2 = 0.0;
  const auto samples = run(source, Instant{}, 100s);
  for (const auto& s : samples) {
    x2 += s.pose.position.x * s.pose.position.x;
    yaw2 += s.pose.yaw_rad * s.pose.yaw_rad;
  }
  const auto n = static_cast<double>(samples.size());
  // 3000 samples: the deviation is known to 1.3 %; four of those.
  EXPECT_NEAR(std::sqrt(x2 / n), 0.002, 0.0001);
  EXPECT_NEAR(hal::rad_to_deg(std::sqrt(yaw2 / n)), 0.1, 0.005);
}

TEST(SimPoseSource, DriftGrowsWithTheRootOfTimeHoweverOftenItIsPolled) {
  MovingBody body;
  SimPoseOptions options = perfect();
  options.drift_m_per_sqrt_s = 0.01;
  for (const hal::Duration step : {hal::Duration(5ms), hal::Duration(1s)}) {
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      SimPoseSource source(body, options, seed);
      run(source, Instant{}, 25s, step);
      sum += source.offset_world().x * source.offset_world().x;
    }
    // 0.01 sqrt(25) = 0.05; 200 runs know it to 5 %; four of those.
    EXPECT_NEAR(std::sqrt(sum / 200.0), 0.05, 0.01);
  }
}

TEST(SimPoseSource, JumpsAreAnnouncedOrSilent) {
  MovingBody body;
  SimPoseSource source(body, perfect(), 1);
  EXPECT_EQ(run(source, Instant{}, 100ms).back().reset_counter, 0);
  source.jump({1.0, 0.0, 0.0}, 0.5, false);
  const auto silent = run(source, Instant{} + 1s, 100ms).back();
  EXPECT_DOUBLE_EQ(silent.pose.position.x, 1.0);
  EXPECT_DOUBLE_EQ(silent.pose.yaw_rad, 0.5);
  EXPECT_EQ(silent.reset_counter, 0);
  source.jump({-1.0, 0.0, 0.0}, -0.5, true);
  const auto announced = run(source, Instant{} + 2s, 100ms).back();
  EXPECT_DOUBLE_EQ(announced.pose.position.x, 0.0);
  EXPECT_EQ(announced.reset_counter, 1);
}

TEST(SimPoseSource, DropoutsHoldThePoseAndSaySo) {
  MovingBody body;
  SimPoseOptions options = perfect();
  options.dropouts_per_s = 0.1;
  options.dropout_length = 500ms;
  SimPoseSource source(body, options, 5);
  int failed = 0;
  const auto samples = run(source, Instant{}, 1000s);
  for (const auto& s : samples) failed += s.confidence == PoseConfidence::failed ? 1 : 0;
  // 100 losses of half a second in 1000 s, fewer where they overlap: 4.9 %, known to a tenth of itself.
  EXPECT_NEAR(failed / static_cast<double>(samples.size()), 0.049, 0.02);
}

TEST(SimPoseSource, TurningFastCostsConfidence) {
  MovingBody body;
  SimPoseSource source(body, perfect(), 1);
  body.body.yaw_rate_rad_s = -2.0;
  EXPECT_EQ((*source.poll(Instant{}))->confidence, PoseConfidence::low);
  body.body.yaw_rate_rad_s = 0.3;
  EXPECT_EQ((*source.poll(Instant{} + 1s))->confidence, PoseConfidence::high);
}

TEST(SimPoseSource, FaultsLookLikeTheirCause) {
  MovingBody body;
  SimPoseSource source(body, perfect(), 1);
  EXPECT_TRUE(*source.poll(Instant{}));
  body.body.pose.position.x = 4.0;
  source.set_fault(PoseFault::freeze);
  EXPECT_EQ((*source.poll(Instant{} + 1s))->pose.position.x, 0.0);
  EXPECT_EQ((*source.poll(Instant{} + 2s))->confidence, PoseConfidence::high);
  source.set_fault(PoseFault::lost);
  EXPECT_EQ((*source.poll(Instant{} + 3s))->confidence, PoseConfidence::failed);
  source.set_fault(PoseFault::stall);
  EXPECT_FALSE(*source.poll(Instant{} + 4s));
  source.set_fault(PoseFault::disconnect);
  EXPECT_EQ(source.poll(Instant{} + 5s).error().code, hal::ErrorCode::disconnected);
  source.set_fault(PoseFault::none);
  EXPECT_EQ((*source.poll(Instant{} + 6s))->pose.position.x, 4.0);
}

}  // namespace
}  // namespace forager::mocks
