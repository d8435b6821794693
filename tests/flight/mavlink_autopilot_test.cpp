#include "flight/mavlink_autopilot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/flight/mavlink_bench_autopilot.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::AutopilotBench;
using test::MavlinkPayload;
namespace peer = mocks::peer;

TEST(MavlinkAutopilot, SaysNothingBeforeItsOwnerTakesCharge) {
  AutopilotBench bench;
  bench.owner_alive(false);
  bench.run(5s);
  EXPECT_TRUE(bench.heard().empty());
  EXPECT_TRUE(bench.ours().state().link_up) << "but it listens";
}

TEST(MavlinkAutopilot, ShowsItselfAsACompanionOnceASecond) {
  AutopilotBench bench;
  bench.run(10s);
  const auto beats = bench.heard(peer::kHeartbeat);
  EXPECT_EQ(beats.size(), 10U);
  EXPECT_EQ(beats.at(0).system, 1);
  EXPECT_EQ(beats.at(0).component, 191);
  EXPECT_EQ(beats.at(0).payload.get<std::uint8_t>(4), 18);
  EXPECT_EQ(beats.at(0).payload.get<std::uint8_t>(5), 8);
  EXPECT_EQ(beats.at(0).payload.get<std::uint8_t>(8), 3);
}

TEST(MavlinkAutopilot, FallsSilentWhenItsOwnerDiesAndSpeaksAgainWhenItReturns) {
  AutopilotBench bench;
  bench.connect();
  bench.ours().set_position({{1, 2, 3}, 0.0, bench.now() + 1h});
  bench.run(2s);
  bench.owner_alive(false);
  bench.run(500ms);  // the deadman time
  bench.clear();
  bench.run(5s);
  EXPECT_TRUE(bench.heard(peer::kHeartbeat).empty());
  EXPECT_TRUE(bench.heard(peer::kSetPositionTargetLocalNed).empty());
  EXPECT_EQ(bench.journal().count("deadman expired"), 1U);
  bench.owner_alive(true);
  bench.run(5s);
  EXPECT_EQ(bench.heard(peer::kHeartbeat).size(), 5U);
  EXPECT_TRUE(bench.heard(peer::kSetPositionTargetLocalNed).empty())
      << "an old goal must not come back to life";
}

TEST(MavlinkAutopilot, KnowsTheAutopilotByWhatItSaysNotByItsId) {
  AutopilotBench bench;
  bench.heartbeats(false);
  mocks::MavlinkPeerPacker ground_station(255, 190);
  mocks::MavlinkPeerPacker camera(7, 1);
  mocks::MavlinkPeerPacker autopilot(42, 1);
  bench.run(100ms);
  bench.send_heartbeat(ground_station, 8);
  bench.send_heartbeat(camera, 8);
  bench.run(100ms);
  EXPECT_FALSE(bench.ours().state().link_up);
  bench.send_heartbeat(autopilot, 3);
  bench.run(1s);
  EXPECT_TRUE(bench.ours().state().link_up);
  const auto asks = bench.commands(peer::kSetMessageInterval);
  ASSERT_FALSE(asks.empty());
  EXPECT_EQ(asks[0].payload.get<std::uint8_t>(30), 42);
  EXPECT_EQ(asks[0].payload.get<std::uint8_t>(31), 1);
}

TEST(MavlinkAutopilot, NoticesALostAndAReturnedLink) {
  AutopilotBench bench;
  bench.run(2s);
  ASSERT_TRUE(bench.ours().state().link_up);
  bench.heartbeats(false);
  bench.run(1500ms);  // the last one came about a second earlier
  EXPECT_TRUE(bench.ours().state().link_up);
  bench.run(1s);
  EXPECT_FALSE(bench.ours().state().link_up);
  bench.clear();
  bench.heartbeats(true);
  bench.run(1s);
  EXPECT_TRUE(bench.ours().state().link_up);
  EXPECT_GE(bench.commands(peer::kSetMessageInterval).size(), 5U) << "it may have forgotten its streams";
}

TEST(MavlinkAutopilot, AsksForStreamsUntilTheyComeAndAgainWhenTheyStop) {
  AutopilotBench bench;
  const auto asked = [&](float id) {
    std::size_t count = 0;
    for (const auto& ask : bench.commands(peer::kSetMessageInterval))
      count += ask.payload.get<float>(0) == id;
    return count;
  };
  bench.run(1s);
  for (const float id : {32.0F, 30.0F, 245.0F, 1.0F, 147.0F}) EXPECT_EQ(asked(id), 1U) << id;
  EXPECT_EQ(bench.commands(peer::kSetMessageInterval).at(0).payload.get<float>(4), 50'000.0F);
  bench.run(2s);
  EXPECT_GE(asked(32.0F), 2U) << "nothing came";
  for (int i = 0; i < 100; ++i) {
    bench.send(peer::kLocalPositionNed, {});
    bench.run(50ms);
  }
  bench.clear();
  for (int i = 0; i < 100; ++i) {
    bench.send(peer::kLocalPositionNed, {});
    bench.run(50ms);
  }
  EXPECT_EQ(asked(32.0F), 0U);
  bench.run(1500ms);
  EXPECT_EQ(asked(32.0F), 1U);
}

TEST(MavlinkAutopilot, SetsTheOriginUntilItIsKnown) {
  MavlinkConfig config;
  config.origin = GlobalOrigin{51.5, -0.125, 20.0};
  AutopilotBench bench(config);
  bench.run(3s);
  const auto origins = bench.heard(peer::kSetGpsGlobalOrigin);
  ASSERT_EQ(origins.size(), 2U);
  EXPECT_EQ(origins[0].payload.get<std::int32_t>(0), 515'000'000);
  EXPECT_EQ(origins[0].payload.get<std::int32_t>(4), -1'250'000);
  EXPECT_EQ(origins[0].payload.get<std::int32_t>(8), 20'000);
  bench.send(peer::kGpsGlobalOrigin, {});
  bench.clear();
  bench.run(10s);
  EXPECT_TRUE(bench.heard(peer::kSetGpsGlobalOrigin).empty());
}

TEST(MavlinkAutopilot, TurnsItsNedStateIntoOurWorld) {
  AutopilotBench bench;
  bench.connect();
  MavlinkPayload position;
  position.f32(4, 1.0);
  position.f32(8, 2.0);
  position.f32(12, -3.0);
  position.f32(16, 0.5);
  position.f32(20, 0.25);
  position.f32(24, -0.125);
  bench.send(peer::kLocalPositionNed, position);
  bench.step();
  EXPECT_FALSE(bench.ours().state().pose_valid) << "the attitude is missing";
  MavlinkPayload attitude;
  attitude.f32(4, 0.125);
  attitude.f32(8, 0.25);
  attitude.f32(12, 1.5);
  bench.send(peer::kAttitude, attitude);
  MavlinkPayload battery;
  battery.put<std::int8_t>(30, 73);
  bench.send(peer::kSysStatus, battery);
  MavlinkPayload landed;
  landed.put<std::uint8_t>(1, 2);
  bench.send(peer::kExtendedSysState, landed);
  bench.step();
  const AutopilotState& state = bench.ours().state();
  EXPECT_TRUE(state.pose_valid);
  EXPECT_EQ(state.pose_world.position, (hal::Vec3{1.0, -2.0, 3.0}));
  EXPECT_EQ(state.velocity_world_m_s, (hal::Vec3{0.5, -0.25, 0.125}));
  EXPECT_DOUBLE_EQ(state.pose_world.yaw_rad, -1.5);
  EXPECT_DOUBLE_EQ(state.pose_world.pitch_rad, -0.25);
  EXPECT_DOUBLE_EQ(state.pose_world.roll_rad, 0.125);
  EXPECT_DOUBLE_EQ(state.battery_fraction.value_or(-1), 0.73);
  EXPECT_TRUE(state.in_air);
  bench.run(600ms);
  EXPECT_FALSE(bench.ours().state().pose_valid) << "it grew old";
}

TEST(MavlinkAutopilot, UnknownBatteryIsNotAnEmptyOne) {
  AutopilotBench bench;
  bench.connect();
  MavlinkPayload battery;
  battery.put<std::int8_t>(30, -1);
  bench.send(peer::kSysStatus, battery);
  bench.step();
  EXPECT_FALSE(bench.ours().state().battery_fraction);
}

TEST(MavlinkAutopilot, AnswersTimesyncWithItsOwnClock) {
  AutopilotBench bench;
  bench.connect();
  MavlinkPayload ask;
  ask.put<std::int64_t>(8, 123'456'789);
  bench.send(peer::kTimesync, ask);
  bench.step();
  const auto answers = bench.heard(peer::kTimesync);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].payload.get<std::int64_t>(0), bench.now().time_since_epoch().count());
  EXPECT_EQ(answers[0].payload.get<std::int64_t>(8), 123'456'789);
  EXPECT_EQ(answers[0].payload.get<std::uint8_t>(16), 1);
  bench.clear();
  MavlinkPayload answer;
  answer.put<std::int64_t>(0, 5);
  answer.put<std::int64_t>(8, 4);
  bench.send(peer::kTimesync, answer);
  bench.step();
  EXPECT_TRUE(bench.heard(peer::kTimesync).empty()) << "an answer is not answered";
}

TEST(MavlinkAutopilot, SendsVisionAtNoMoreThan50Hertz) {
  AutopilotBench bench;
  bench.connect();
  for (int i = 0; i < 200; ++i) {  // 1 s at 200 Hz
    hal::PoseSample sample;
    sample.stamp = bench.now() + i * 5ms;
    sample.pose = {{1, 2, 3}, 0.5, 0.25, 0.125};
    sample.reset_counter = 9;
    bench.ours().send_vision(sample);
  }
  bench.step();
  const auto frames = bench.heard(peer::kVisionPositionEstimate);
  ASSERT_EQ(frames.size(), 50U);
  const auto& p = frames[1].payload;
  EXPECT_EQ(p.get<std::uint64_t>(0) - frames[0].payload.get<std::uint64_t>(0), 20'000U);
  EXPECT_EQ(p.get<float>(8), 1.0F);
  EXPECT_EQ(p.get<float>(12), -2.0F);
  EXPECT_EQ(p.get<float>(16), -3.0F);
  EXPECT_EQ(p.get<float>(20), 0.125F);
  EXPECT_EQ(p.get<float>(24), -0.25F);
  EXPECT_EQ(p.get<float>(28), -0.5F);
  EXPECT_TRUE(std::isnan(p.get<float>(32)));
  EXPECT_EQ(p.get<std::uint8_t>(116), 9);
}

TEST(MavlinkAutopilot, OpensTheLineAgainWithGrowingPauses) {
  MavlinkConfig config;
  AutopilotBench bench(config, mocks::MemoryStreamKind::bytes);
  bench.connect();
  EXPECT_EQ(bench.ours().link().stats().opens, 1U);
  bench.line().refuse_connects(true);
  bench.line().drop();
  bench.run(20s);
  EXPECT_FALSE(bench.ours().link().is_open());
  const std::size_t tries = bench.journal().count("link failed");
  EXPECT_GE(tries, 7U);  // 0.25, 0.5, 1, 2, 4, 4, ...
  EXPECT_LE(tries, 10U) << "it hammers";
  bench.line().refuse_connects(false);
  bench.run(6s);
  EXPECT_TRUE(bench.ours().link().is_open());
  EXPECT_TRUE(bench.ours().state().link_up);
}

TEST(MavlinkAutopilot, AFrameTheLineTakesInPiecesArrivesWhole) {
  AutopilotBench bench({}, mocks::MemoryStreamKind::bytes);
  bench.run(1s);
  bench.clear();
  bench.line().limit_in_flight(7);
  bench.run(8s);
  EXPECT_GE(bench.heard(peer::kHeartbeat).size(), 7U);
}

TEST(MavlinkAutopilot, JournalsTheWireOnlyWhenAsked) {
  AutopilotBench quiet;
  quiet.run(2s);
  EXPECT_EQ(quiet.journal().count(" tx "), 0U);
  MavlinkConfig config;
  config.journal_wire = true;
  AutopilotBench bench(config);
  bench.run(2s);
  EXPECT_GE(bench.journal().count("autopilot tx fd"), 2U);
  EXPECT_GE(bench.journal().count("autopilot rx fd"), 2U);
}

TEST(MavlinkAutopilot, RefusesAConfigurationThatCannotWork) {
  mocks::MemoryStreamPair line("udp autopilot", mocks::MemoryStreamKind::datagrams);
  hal::NullJournal journal;
  const auto refuses = [&](hal::Duration MavlinkConfig::*interval, const char* name) {
    MavlinkConfig config;
    config.*interval = 0s;
    const auto made =
        MavlinkAutopilot::create(line.near(), journal, config, {}, MotorBay().claim("autopilot").value());
    ASSERT_FALSE(made) << name;
    EXPECT_EQ(made.error().code, hal::ErrorCode::invalid_argument);
    EXPECT_NE(hal::describe(made.error()).find(name), std::string::npos);
  };
  refuses(&MavlinkConfig::setpoint_interval, "setpoint_interval");
  refuses(&MavlinkConfig::attitude_interval, "attitude_interval");
  refuses(&MavlinkConfig::vision_interval, "vision_interval");
}

TEST(MavlinkAutopilot, WithAKeyItBelievesOnlySignedFrames) {
  MavlinkConfig config;
  config.signing = MavlinkSigningConfig{};
  if (const auto probe = mavlink::Sha256::create(); !probe) GTEST_SKIP() << hal::describe(probe.error());
  AutopilotBench bench(config);
  bench.run(3s);
  EXPECT_FALSE(bench.ours().state().link_up);
  EXPECT_EQ(bench.ours().link().stats().frames_unauthentic, 3U);
  EXPECT_GE(bench.heard(peer::kHeartbeat).size(), 3U) << "a peer without a key still reads signed frames";
}

}  // namespace
}  // namespace forager::flight
