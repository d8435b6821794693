#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/mocks/autopilot_client.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Vec3;
using peer::CopterMode;
using peer::Result;

TEST(SimAutopilotVision, AJumpWithTheResetCounterMovesTheEstimateNotTheVehicle) {
  AutopilotBench bench;
  bench.fly();
  bench.stream(peer::kLocalPositionNed, 25);
  bench.run(2s);
  const Vec3 before = bench.truth().pose.position;
  bench.vision_offset = {0.6, 0.0, 0.0};
  ++bench.reset_counter;
  bench.run(400ms);
  EXPECT_NEAR(bench.message(peer::kLocalPositionNed).f32(4), before.x + 0.6, 0.02);
  double moved = 0.0;
  bench.run(10s, [&] { moved = std::max(moved, hal::norm(bench.truth().pose.position - before)); });
  EXPECT_LT(moved, 0.03);
}

TEST(SimAutopilotVision, TheSameJumpWithoutTheCounterMovesTheVehicle) {
  AutopilotBench bench;
  bench.fly();
  bench.run(2s);
  const Vec3 before = bench.truth().pose.position;
  bench.vision_offset = {0.6, 0.0, 0.0};
  bench.run(10s);
  // It believes to be 0.6 m too far and goes back (SITL: 0.5 m).
  EXPECT_NEAR(bench.truth().pose.position.x, before.x - 0.6, 0.1);
}

TEST(SimAutopilotVision, LosingVisionDriftsAndLandsAfterTheFailsafe) {
  AutopilotBench bench;
  bench.fly(2.0);
  bench.stream(peer::kEkfStatusReport, 5);
  const Vec3 before = bench.truth().pose.position;
  const hal::Instant lost = bench.now();
  bench.vision = false;
  bench.run(7500ms);
  EXPECT_EQ(bench.sim().mode(), CopterMode::guided);
  const auto off = [&] { return hal::distance_xy(bench.truth().pose.position, before); };
  EXPECT_GT(off(), 1.0);
  EXPECT_NEAR(hal::norm(bench.truth().velocity_world_m_s), 0.5, 0.15);
  while (bench.sim().mode() != CopterMode::land && bench.now() - lost < 20s) bench.run(20ms);
  EXPECT_NEAR(hal::to_seconds(bench.now() - lost), 7.9, 0.1);
  EXPECT_TRUE(bench.heard_text("EKF variance"));
  EXPECT_TRUE(bench.heard_text("changed to LAND"));
  while (!bench.truth().on_ground && bench.now() - lost < 60s) bench.run(20ms);
  EXPECT_NEAR(off(), 4.0, 1.5);  // SITL: about 4 m by touch-down
  EXPECT_NE(bench.message(peer::kEkfStatusReport).get<std::uint16_t>(20) & 0x80, 0);
  bench.run(3s);
  EXPECT_FALSE(bench.sim().armed());
}

TEST(SimAutopilotVision, AShortGapIsMended) {
  AutopilotBench bench;
  bench.fly();
  const Vec3 before = bench.truth().pose.position;
  bench.vision = false;
  bench.run(1s);
  bench.vision = true;
  bench.run(5s);
  EXPECT_EQ(bench.sim().mode(), CopterMode::guided);
  EXPECT_LT(hal::norm(bench.truth().pose.position - before), 0.05);
  EXPECT_TRUE(bench.texts.empty() || !bench.heard_text("EKF"));
}

TEST(SimAutopilotVision, DropsWhatComesFasterThan50Hz) {
  AutopilotBench bench;
  bench.vision = false;
  bench.tick = 10ms;
  bench.run(2s, [&] { bench.send_vision(); });
  const auto& estimator = bench.sim().estimator();
  EXPECT_EQ(estimator.samples() + estimator.dropped(), 200u);
  EXPECT_EQ(estimator.samples(), 100u);
}

TEST(SimAutopilotVision, FourHertzIsEnoughThreeIsNot) {
  struct Rate {
    hal::Duration period;
    bool healthy;
  };
  for (const Rate rate : {Rate{250ms, true}, Rate{340ms, false}}) {
    AutopilotBench bench;
    bench.vision = false;
    bool always = true;
    hal::Instant next = bench.now();
    int warm = 0;
    bench.run(5s, [&] {
      if (bench.now() >= next) {
        next += rate.period;
        bench.send_vision();
        ++warm;
      }
      if (warm > 2) always = always && bench.sim().estimator().healthy(bench.now());
    });
    EXPECT_EQ(always, rate.healthy);
  }
}

// The camera's frame may point anywhere; the vehicle flies in it.
TEST(SimAutopilotVision, FliesInTheFrameOfTheVision) {
  AutopilotBench bench;
  bench.vision_frame_yaw = -hal::kPi / 2;  // the world's x is the camera's east
  bench.fly();
  EXPECT_NEAR(bench.sim().estimator().estimate().yaw_rad, hal::kPi / 2, 0.01);
  bench.setpoint(0xDF8, {2.0, 1.0, -1.5});
  bench.run(6s);
  EXPECT_NEAR(bench.truth().pose.position.x, 1.0, 0.02);
  EXPECT_NEAR(bench.truth().pose.position.y, 2.0, 0.02);
}

// Positions and headings that do not belong together make a real vehicle run away.
TEST(SimAutopilotVision, RunsAwayWhenHeadingAndPositionContradict) {
  AutopilotBench bench;
  bench.vision_yaw_error = hal::kPi;
  bench.fly();
  bench.setpoint(0xDF8, {2.0, 0.0, -1.5});
  bench.run(10s);
  EXPECT_LT(bench.truth().pose.position.x, -2.0);
}

TEST(SimAutopilotVision, YawDriftIsHeldByVisionAndRunsWithoutIt) {
  AutopilotBench bench;
  bench.fly();
  bench.sim().faults().yaw_drift_rad_s = 0.05;
  bench.run(20s);
  EXPECT_NEAR(bench.truth().pose.yaw_rad, 0.0, 0.02);
  bench.vision = false;
  bench.run(5s);
  EXPECT_NEAR(std::abs(bench.truth().pose.yaw_rad), 0.25, 0.05);
}

TEST(SimAutopilotVision, TakesOdometryOnlyInItsFrames) {
  AutopilotBench bench;
  bench.vision = false;
  const auto send = [&](std::uint8_t frame) {
    MavlinkPayload p;
    p.f32(8, 1.0);
    p.f32(12, 2.0);
    p.f32(16, -0.5);
    p.f32(20, std::cos(0.2));
    p.f32(32, std::sin(0.2));
    p.put(228, frame);
    p.put(229, std::uint8_t{12});
    bench.send(peer::kOdometry, p);
    bench.run(40ms);
  };
  send(1);
  EXPECT_EQ(bench.sim().estimator().samples(), 0u);
  send(20);
  EXPECT_EQ(bench.sim().estimator().samples(), 1u);
  EXPECT_NEAR(bench.sim().estimator().estimate().position_m.y, 2.0, 1e-6);
  EXPECT_NEAR(bench.sim().estimator().estimate().yaw_rad, 0.4, 1e-6);
}

}  // namespace
}  // namespace forager::mocks
