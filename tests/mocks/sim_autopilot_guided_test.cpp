#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/mocks/autopilot_client.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Vec3;

constexpr std::uint16_t kPositionYaw = 0x9F8;  // position and yaw
constexpr std::uint16_t kPositionOnly = 0xDF8;
constexpr std::uint16_t kVelocityOnly = 0xDC7;
constexpr std::uint16_t kVelocityYawRate = 0x5C7;

TEST(SimAutopilotGuided, FliesToAPositionAndTurnsAndStaysThere) {
  AutopilotBench bench;
  bench.fly();
  bench.stream(peer::kLocalPositionNed, 10);
  bench.stream(peer::kAttitude, 10);
  bench.setpoint(kPositionYaw, {3.0, -2.0, -1.5}, {}, -hal::kPi / 2);
  double fastest = 0.0;
  bench.run(10s, [&] {
    const Vec3 v = bench.truth().velocity_world_m_s;
    fastest = std::max(fastest, std::hypot(v.x, v.y));
  });
  EXPECT_LE(fastest, 1.0 + 1e-3);
  EXPECT_GT(fastest, 0.95);
  // Left is -east: y of the world.
  EXPECT_NEAR(bench.truth().pose.position.x, 3.0, 0.02);
  EXPECT_NEAR(bench.truth().pose.position.y, 2.0, 0.02);
  EXPECT_NEAR(bench.truth().pose.position.z, 1.5, 0.02);
  EXPECT_NEAR(bench.truth().pose.yaw_rad, hal::kPi / 2, 0.01);
  bench.run(20s);  // a position does not expire
  EXPECT_NEAR(bench.truth().pose.position.x, 3.0, 0.02);
  const MavlinkPayload& local = bench.message(peer::kLocalPositionNed);
  EXPECT_NEAR(local.f32(4), 3.0, 0.02);
  EXPECT_NEAR(local.f32(8), -2.0, 0.02);
  EXPECT_NEAR(local.f32(12), -1.5, 0.02);
  EXPECT_NEAR(bench.message(peer::kAttitude).f32(12), -hal::kPi / 2, 0.01);
}

TEST(SimAutopilotGuided, BodyFramesTurnWithTheHeadingAndAddToThePosition) {
  AutopilotBench bench;
  bench.fly();
  bench.setpoint(kPositionYaw, {0, 0, -1.5}, {}, hal::kPi / 2);  // face east: right, -y of the world
  bench.run(6s);
  bench.setpoint(kPositionOnly, {1.0, 0.5, 0.0}, {}, 0.0, 0.0, peer::kBodyOffsetNed);
  bench.run(8s);
  EXPECT_NEAR(bench.truth().pose.position.x, -0.5, 0.02);
  EXPECT_NEAR(bench.truth().pose.position.y, -1.0, 0.02);
  bench.setpoint(kPositionOnly, {1.0, 0.0, -0.5}, {}, 0.0, 0.0, peer::kLocalOffsetNed);
  bench.run(8s);
  EXPECT_NEAR(bench.truth().pose.position.x, 0.5, 0.03);
  EXPECT_NEAR(bench.truth().pose.position.z, 2.0, 0.02);
  bench.setpoint(kPositionYaw, {0, 0, 0}, {}, -0.5, 0.0, peer::kBodyNed);
  bench.run(5s);
  EXPECT_NEAR(bench.truth().pose.yaw_rad, 0.5 - hal::kPi / 2, 0.01);
}

TEST(SimAutopilotGuided, VelocityCoastsForTheGuidedTimeoutThenHolds) {
  AutopilotBench bench;
  bench.fly();
  bench.setpoint(kVelocityOnly, {}, {-0.5, 0, 0});
  bench.run(2s);
  EXPECT_NEAR(bench.truth().velocity_world_m_s.x, -0.5, 0.01);
  bench.setpoint(kVelocityOnly, {}, {-0.5, 0, 0});
  bench.run(20ms);
  const double from = bench.truth().pose.position.x;
  bench.run(2s);
  EXPECT_NEAR(bench.truth().velocity_world_m_s.x, -0.5, 0.01);  // flies on 2 s after the last setpoint
  bench.run(4s);
  EXPECT_NEAR(bench.truth().velocity_world_m_s.x, 0.0, 0.01);  // still after 6 s
  // 3 s at 0.5 m/s and the braking; SITL: about 1.8 m.
  EXPECT_NEAR(from - bench.truth().pose.position.x, 1.65, 0.15);
}

TEST(SimAutopilotGuided, TheGuidedTimeoutIsAParameter) {
  AutopilotBench bench;
  bench.fly();
  MavlinkPayload p;
  p.f32(0, 0.5);
  p.put(4, std::uint8_t{1});
  p.text(6, 16, "GUID_TIMEOUT");
  p.put(22, std::uint8_t{9});
  bench.send(peer::kParamSet, p);
  bench.run(100ms);
  EXPECT_NEAR(bench.message(peer::kParamValue).f32(0), 0.5, 1e-6);
  bench.setpoint(kVelocityYawRate, {}, {0.5, 0, 0}, 0.0, 0.4);
  bench.run(400ms);
  EXPECT_NEAR(bench.truth().yaw_rate_rad_s, -0.4, 0.01);
  bench.run(2s);
  EXPECT_NEAR(bench.truth().velocity_world_m_s.x, 0.0, 0.02);
  EXPECT_NEAR(bench.truth().yaw_rate_rad_s, 0.0, 0.01);
}

TEST(SimAutopilotGuided, AnyIgnoreBitIgnoresTheTripleAndABadMaskStops) {
  AutopilotBench bench;
  bench.fly();
  // VX ignored: no velocity left, no position either: it stops.
  bench.setpoint(kVelocityOnly, {}, {0.8, 0, 0});
  bench.run(2s);
  ASSERT_GT(bench.truth().velocity_world_m_s.x, 0.7);
  bench.setpoint(kVelocityOnly | 0x8, {}, {0.8, 0, 0});
  bench.run(3s);
  EXPECT_LT(std::abs(bench.truth().velocity_world_m_s.x), 0.02);
  bench.setpoint(kVelocityOnly, {}, {0.8, 0, 0});
  bench.run(2s);
  bench.setpoint(kVelocityOnly, {}, {0.8, 0, 0}, 0, 0, 20);  // LOCAL_FRD is not one of its frames
  bench.run(3s);
  EXPECT_LT(std::abs(bench.truth().velocity_world_m_s.x), 0.02);
}

TEST(SimAutopilotGuided, IgnoresSetpointsOutsideGuidedAndOnTheGround) {
  AutopilotBench bench;
  bench.send_origin();
  bench.run(2s);
  (void)bench.command(peer::kDoSetMode, {1, 4});
  (void)bench.command(peer::kComponentArmDisarm, {1});
  bench.setpoint(kPositionOnly, {2, 0, -1});
  bench.run(3s);
  EXPECT_EQ(bench.truth().pose.position, Vec3{});
  AutopilotBench flying;
  flying.fly();
  (void)flying.command(peer::kDoSetMode, {1, 5});  // LOITER
  flying.setpoint(kPositionOnly, {2, 0, -1});
  flying.run(3s);
  EXPECT_NEAR(flying.truth().pose.position.x, 0.0, 0.02);
  EXPECT_EQ(flying.sim().setpoints_taken(), 0u);
  EXPECT_EQ(flying.sim().setpoints_ignored(), 1u);
}

}  // namespace
}  // namespace forager::mocks
