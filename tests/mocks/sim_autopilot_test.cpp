#include "mocks/sim_autopilot.hpp"

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

constexpr std::uint16_t kPositionOnly = 0xDF8;

TEST(SimAutopilot, SaysOnlyHeartbeatAndTimesyncUntilAsked) {
  AutopilotBench bench;
  bench.vision = false;
  bench.run(20s);
  EXPECT_EQ(bench.count(peer::kHeartbeat), 20u);
  EXPECT_EQ(bench.count(peer::kTimesync), 2u);
  EXPECT_EQ(bench.counts.size(), 2u);
  const MavlinkPayload& heartbeat = bench.message(peer::kHeartbeat);
  EXPECT_EQ(heartbeat.get<std::uint32_t>(0), 0u);
  EXPECT_EQ(heartbeat.get<std::uint8_t>(4), 13);
  EXPECT_EQ(heartbeat.get<std::uint8_t>(5), 3);
  EXPECT_EQ(heartbeat.get<std::uint8_t>(6), 81);  // disarmed STABILIZE of an ArduCopter
  EXPECT_EQ(heartbeat.get<std::uint8_t>(7), 3);
  EXPECT_EQ(heartbeat.get<std::uint8_t>(8), 3);
}

TEST(SimAutopilot, StreamsAtTheAskedRateAndDeniesWhatItCannot) {
  AutopilotBench bench;
  EXPECT_EQ(bench.command(peer::kSetMessageInterval, {30, 100000}), Result::accepted);
  const auto before = bench.count(peer::kAttitude);
  bench.run(10s);
  EXPECT_NEAR(static_cast<double>(bench.count(peer::kAttitude) - before), 100.0, 1.0);
  EXPECT_EQ(bench.command(peer::kSetMessageInterval, {30, 3000}), Result::denied);     // above 0.8 x 400 Hz
  EXPECT_EQ(bench.command(peer::kSetMessageInterval, {331, 100000}), Result::denied);  // ODOMETRY
  EXPECT_EQ(bench.command(peer::kSetMessageInterval, {30, -1}), Result::accepted);
  const auto off = bench.count(peer::kAttitude);
  bench.run(2s);
  EXPECT_EQ(bench.count(peer::kAttitude), off);
  EXPECT_EQ(bench.command(peer::kRequestMessage, {30}), Result::accepted);
  EXPECT_EQ(bench.count(peer::kAttitude), off + 1);
  EXPECT_EQ(bench.command(peer::kRequestMessage, {331}), Result::failed);
  EXPECT_EQ(bench.command(peer::kGetMessageInterval, {0}), Result::accepted);
  EXPECT_EQ(bench.message(peer::kMessageInterval).get<std::int32_t>(0), 1000000);
}

TEST(SimAutopilot, RefusesUnknownCommands) {
  AutopilotBench bench;
  EXPECT_EQ(bench.command(187, {0.5}), Result::unsupported);  // DO_SET_ACTUATOR
  EXPECT_EQ(bench.command(31000), Result::unsupported);
  EXPECT_EQ(bench.command(peer::kDoSetMode, {0, 4}), Result::denied);
  EXPECT_EQ(bench.command(peer::kDoSetMode, {1, 77}), Result::failed);
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {2}), Result::unsupported);
}

TEST(SimAutopilot, AnswersNobodyElsesCommands) {
  AutopilotBench bench;
  MavlinkPayload p;
  p.put(28, peer::kNavLand);
  p.put(30, std::uint8_t{9});
  bench.send(peer::kCommandLong, p);
  bench.run(500ms);
  EXPECT_EQ(bench.count(peer::kCommandAck), 0u);
  EXPECT_EQ(bench.sim().mode(), CopterMode::stabilize);
}

TEST(SimAutopilot, ArmsOnlyWhenThePreArmChecksPass) {
  AutopilotBench bench;
  bench.vision = false;
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::failed);
  EXPECT_EQ(bench.texts.back(), "PreArm: AHRS: waiting for home");
  bench.send_origin();
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::failed);
  EXPECT_EQ(bench.texts.back(), "PreArm: VisOdom: not healthy");
  bench.vision = true;
  bench.run(2s);
  bench.sim().set_battery_fraction(0.1);
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::failed);
  EXPECT_TRUE(bench.heard_text("Battery 1 below minimum"));
  bench.sim().set_battery_fraction(0.9);
  bench.sim().faults().refuse_arming = "PreArm: Hardware safety switch";
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::failed);
  EXPECT_EQ(bench.texts.back(), "PreArm: Hardware safety switch");
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1, 21196}), Result::accepted);
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {0}), Result::accepted);
  bench.sim().faults().refuse_arming.clear();
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::accepted);
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::accepted);  // armed already
  EXPECT_TRUE(bench.sim().armed());
  EXPECT_EQ(bench.message(peer::kGpsGlobalOrigin).get<std::int32_t>(0), 414036000);
}

TEST(SimAutopilot, DisarmsItselfWhenItNeverTakesOff) {
  AutopilotBench bench;
  bench.send_origin();
  bench.run(2s);
  ASSERT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::accepted);
  bench.run(9500ms);
  EXPECT_TRUE(bench.sim().armed());
  bench.run(500ms);
  EXPECT_FALSE(bench.sim().armed());
  EXPECT_EQ(bench.truth().pose.position, Vec3{});
}

TEST(SimAutopilot, TakesOffOnlyInGuidedAndArmed) {
  AutopilotBench bench;
  bench.send_origin();
  bench.run(2s);
  const std::vector<double> takeoff{0, 0, 0, 0, 0, 0, 1.5};
  EXPECT_EQ(bench.command(peer::kNavTakeoff, takeoff), Result::failed);
  ASSERT_EQ(bench.command(peer::kComponentArmDisarm, {1}), Result::accepted);
  EXPECT_EQ(bench.command(peer::kNavTakeoff, takeoff), Result::failed);  // STABILIZE
  ASSERT_EQ(bench.command(peer::kDoSetMode, {1, 4}), Result::accepted);
  bench.stream(peer::kExtendedSysState, 10);
  EXPECT_EQ(bench.message(peer::kExtendedSysState).get<std::uint8_t>(1), 1);
  EXPECT_EQ(bench.command(peer::kNavTakeoff, takeoff), Result::accepted);
  bench.run(1s);
  EXPECT_EQ(bench.message(peer::kExtendedSysState).get<std::uint8_t>(1), 3);
  EXPECT_EQ(bench.command(peer::kNavTakeoff, takeoff), Result::failed);  // flies already
  double highest = 0.0;
  bench.run(10s, [&] { highest = std::max(highest, bench.truth().pose.position.z); });
  EXPECT_NEAR(bench.truth().pose.position.z, 1.5, 0.01);
  EXPECT_LT(highest, 1.53);
  EXPECT_EQ(bench.message(peer::kExtendedSysState).get<std::uint8_t>(1), 2);
  EXPECT_EQ(bench.command(peer::kComponentArmDisarm, {0}), Result::failed);  // not in the air
}

TEST(SimAutopilot, LandsAndDisarmsTwoSecondsAfterTouchDown) {
  AutopilotBench bench;
  bench.fly();
  ASSERT_EQ(bench.command(peer::kNavLand), Result::accepted);
  EXPECT_EQ(bench.sim().mode(), CopterMode::land);
  bench.run(1s);
  EXPECT_NEAR(bench.truth().velocity_world_m_s.z, -0.5, 0.01);
  while (!bench.truth().on_ground && bench.now() < hal::Instant(60s)) bench.run(20ms);
  const hal::Instant touched = bench.now();
  EXPECT_EQ(bench.sim().vehicle().hard_landings(), 0u);
  while (bench.sim().armed() && bench.now() < hal::Instant(60s)) bench.run(20ms);
  EXPECT_NEAR(hal::to_seconds(bench.now() - touched), 2.0, 0.1);
}

TEST(SimAutopilot, ReturnsHomeAndLands) {
  SimAutopilotConfig config;
  config.rtl_altitude_m = 2.0;
  AutopilotBench bench(config);
  bench.fly(1.0);
  bench.setpoint(kPositionOnly, {3, 1, -1});
  bench.run(8s);
  ASSERT_EQ(bench.command(peer::kNavReturnToLaunch), Result::accepted);
  double highest = 0.0;
  bench.run(25s, [&] { highest = std::max(highest, bench.truth().pose.position.z); });
  EXPECT_NEAR(highest, 2.0, 0.05);
  EXPECT_LT(std::hypot(bench.truth().pose.position.x, bench.truth().pose.position.y), 0.15);
  EXPECT_TRUE(bench.truth().on_ground);
  EXPECT_FALSE(bench.sim().armed());
}

TEST(SimAutopilot, TurnsByConditionYaw) {
  AutopilotBench bench;
  bench.fly();
  ASSERT_EQ(bench.command(peer::kConditionYaw, {90, 30, 0, 0}), Result::accepted);
  double fastest = 0.0;
  bench.run(5s, [&] { fastest = std::max(fastest, std::abs(bench.truth().yaw_rate_rad_s)); });
  EXPECT_NEAR(bench.truth().pose.yaw_rad, -hal::kPi / 2, 0.01);
  EXPECT_LT(fastest, hal::deg_to_rad(33));
  // Back to north the long way round, clockwise.
  double turned = 0.0;
  double before = bench.truth().pose.yaw_rad;
  ASSERT_EQ(bench.command(peer::kConditionYaw, {0, 0, 1, 0}), Result::accepted);
  bench.run(10s, [&] {
    turned += hal::angle_difference(bench.truth().pose.yaw_rad, before);
    before = bench.truth().pose.yaw_rad;
  });
  EXPECT_NEAR(bench.truth().pose.yaw_rad, 0.0, 0.01);
  EXPECT_LT(turned, -hal::deg_to_rad(240));
  EXPECT_EQ(bench.command(peer::kConditionYaw, {400, 0, 0, 0}), Result::failed);
}

TEST(SimAutopilot, MovesServosButNotMotors) {
  AutopilotBench bench;
  EXPECT_EQ(bench.command(peer::kDoSetServo, {9, 1700}), Result::accepted);
  EXPECT_EQ(bench.sim().servo_us(9), 1700);
  EXPECT_EQ(bench.command(peer::kDoSetServo, {6, 1700}), Result::failed);
  EXPECT_EQ(bench.command(peer::kDoSetServo, {17, 1700}), Result::failed);
}

TEST(SimAutopilot, AnswersTimesync) {
  AutopilotBench bench;
  MavlinkPayload p;
  p.put(8, std::int64_t{123456789});
  bench.run(100ms);
  bench.send(peer::kTimesync, p);
  bench.run(20ms);
  const MavlinkPayload& answer = bench.message(peer::kTimesync);
  EXPECT_GT(answer.get<std::int64_t>(0), 0);
  EXPECT_EQ(answer.get<std::int64_t>(8), 123456789);
  EXPECT_EQ(answer.get<std::uint8_t>(16), 1);
  EXPECT_EQ(answer.get<std::uint8_t>(17), 191);
}

TEST(SimAutopilot, ReportsTheBattery) {
  AutopilotBench bench;
  bench.fly();
  bench.stream(peer::kBatteryStatus, 2);
  bench.stream(peer::kSysStatus, 2);
  bench.sim().faults().battery = SimAutopilotFaults::BatteryJump{0s, 0.5};
  bench.run(152s);
  // 25 min of hover: 150 s take a tenth.
  EXPECT_NEAR(bench.sim().vehicle().battery_fraction(), 0.4, 0.005);
  EXPECT_NEAR(bench.message(peer::kBatteryStatus).get<std::int8_t>(35), 39, 1);
  EXPECT_NEAR(bench.message(peer::kSysStatus).get<std::int8_t>(30), 39, 1);
  const int millivolts = bench.message(peer::kSysStatus).get<std::uint16_t>(14);
  EXPECT_GT(millivolts, 14000);
  EXPECT_LT(millivolts, 15200);
}

}  // namespace
}  // namespace forager::mocks
