#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "mocks/text_journal.hpp"
#include "tests/mocks/autopilot_client.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Vec3;
using peer::CopterMode;

SimAutopilotFaults bad_line() {
  SimAutopilotFaults faults;
  faults.tx = {.drop = 0.1, .duplicate = 0.05, .corrupt = 0.05};
  faults.rx = {.drop = 0.05, .duplicate = 0.05, .corrupt = 0.05};
  return faults;
}

// A flight with everything in it. The autopilot is updated every `tick`; all talk is at multiples of 240 ms.
std::vector<std::byte> flight_bytes(hal::Duration tick, std::uint64_t seed, bool faulty) {
  SimAutopilotConfig config;
  config.seed = seed;
  config.vehicle.seed = seed;
  config.vehicle.wind_gust_m_s = 1.0;
  AutopilotBench bench(config);
  bench.vision = false;
  bench.run(20ms);
  if (faulty) bench.sim().faults() = bad_line();
  const hal::Instant start = bench.now();
  bench.tick = tick;
  bench.run(30s, [&] {
    if ((bench.now() - start) % 240ms != hal::Duration::zero()) return;
    const auto i = (bench.now() - start) / 240ms;
    bench.sim().update(bench.now());  // hears nothing new; from here the truth does not depend on the tick
    bench.send_vision();
    const auto say = [&](std::uint16_t id, std::vector<double> params) {
      MavlinkPayload p;
      for (std::size_t k = 0; k < params.size(); ++k) p.f32(4 * k, params[k]);
      p.put(28, id);
      bench.send(peer::kCommandLong, p);
    };
    if (i % 5 == 1 && i < 15) say(peer::kSetMessageInterval, {30, 40000});
    if (i % 5 == 2 && i < 15) say(peer::kSetMessageInterval, {32, 50000});
    if (i % 5 == 3 && i < 15) say(peer::kDoSetMode, {1, 4});
    if (i > 15 && i < 20) say(peer::kComponentArmDisarm, {1, 21196});
    if (i > 20 && i < 25) say(peer::kNavTakeoff, {0, 0, 0, 0, 0, 0, 1.0});
    if (i > 40) bench.setpoint(0x9F8, {1.0, 1.0, -1.0}, {}, 1.0);
  });
  EXPECT_GT(bench.truth().pose.position.x, 0.5) << "it did not fly";
  return bench.heard;
}

TEST(SimAutopilotFaults, EqualSeedsGiveEqualBytesAndOthersDoNot) {
  for (const bool faulty : {false, true}) {
    const auto first = flight_bytes(20ms, 7, faulty);
    EXPECT_GT(first.size(), 20000u);
    EXPECT_TRUE(first == flight_bytes(20ms, 7, faulty));
    EXPECT_FALSE(first == flight_bytes(20ms, 8, faulty));
  }
}

TEST(SimAutopilotFaults, TheSpacingOfUpdatesDoesNotMatter) {
  for (const bool faulty : {false, true}) {
    const auto reference = flight_bytes(20ms, 7, faulty);
    for (const hal::Duration tick : {hal::Duration(3ms), hal::Duration(60ms), hal::Duration(240ms)})
      EXPECT_TRUE(reference == flight_bytes(tick, 7, faulty)) << tick.count();
  }
}

TEST(SimAutopilotFaults, FlyingOverABadLineStillWorksAndShowsInTheSequence) {
  AutopilotBench bench;
  bench.fly();
  bench.stream(peer::kAttitude, 50);
  bench.sim().faults() = bad_line();
  bench.run(20s, [&] { bench.setpoint(0x9F8, {1, 0, -1.5}); });
  EXPECT_NEAR(bench.truth().pose.position.x, 1.0, 0.05);
  EXPECT_GT(bench.lost, 50u);
  EXPECT_GT(bench.parser().bad(), 10u);
}

TEST(SimAutopilotFaults, SilenceIsBothWaysAndEnds) {
  AutopilotBench bench;
  bench.sim().faults().silence = SimAutopilotFaults::Window{3s, 8s};
  bench.run(3s);
  const auto before = bench.count(peer::kHeartbeat);
  EXPECT_EQ(bench.command(peer::kRunPrearmChecks), std::nullopt);
  bench.run(4s);
  EXPECT_EQ(bench.count(peer::kHeartbeat), before);
  EXPECT_FALSE(bench.sim().estimator().healthy(bench.now()));
  bench.run(5s);
  EXPECT_GT(bench.count(peer::kHeartbeat), before + 2);
  EXPECT_TRUE(bench.sim().estimator().healthy(bench.now()));
}

TEST(SimAutopilotFaults, HeartbeatsMayStopWhileTheRestGoesOn) {
  AutopilotBench bench;
  bench.sim().faults().heartbeat_stop = 3s;
  bench.stream(peer::kAttitude, 10);
  bench.run(10s);
  EXPECT_LE(bench.count(peer::kHeartbeat), 3u);
  EXPECT_GT(bench.count(peer::kAttitude), 90u);
}

TEST(SimAutopilotFaults, ThePilotTakesOver) {
  TextJournal journal;
  AutopilotBench bench;
  bench.sim().attach(nullptr, &journal);
  bench.sim().faults().pilot = SimAutopilotFaults::PilotMode{15s, CopterMode::loiter};
  bench.fly();
  bench.run(8s);
  EXPECT_EQ(bench.sim().mode(), CopterMode::loiter);
  EXPECT_EQ(journal.count("mode 5 by pilot"), 1u);
  EXPECT_EQ(bench.message(peer::kHeartbeat).get<std::uint32_t>(0), 5u);
  bench.setpoint(0xDF8, {2, 0, -1.5});
  bench.run(4s);
  EXPECT_NEAR(bench.truth().pose.position.x, 0.0, 0.02);
}

TEST(SimAutopilotFaults, IgnoredSetpointsDoNothing) {
  AutopilotBench bench;
  bench.fly();
  bench.sim().faults().ignore_setpoints = true;
  bench.setpoint(0xDF8, {2, 0, -1.5});
  bench.run(4s);
  EXPECT_NEAR(bench.truth().pose.position.x, 0.0, 0.02);
}

TEST(SimAutopilotFaults, AnEmptyBatteryEndsTheFlight) {
  TextJournal journal;
  AutopilotBench bench;
  bench.sim().attach(nullptr, &journal);
  bench.fly(3.0);
  bench.sim().faults().battery = SimAutopilotFaults::BatteryJump{0s, 0.0};
  bench.run(2s);
  EXPECT_TRUE(bench.truth().on_ground);
  EXPECT_EQ(bench.sim().vehicle().hard_landings(), 1u);
  EXPECT_EQ(journal.count("CRASH: hit the floor"), 1u);
}

TEST(SimAutopilotFaults, BumpsIntoBoxesAndReportsIt) {
  TextJournal journal;
  World world;
  world.obstacles.push_back({{2.0, -1.0, 0.0}, {3.0, 1.0, 3.0}});
  AutopilotBench bench;
  bench.sim().attach(&world, &journal);
  bench.fly();
  EXPECT_EQ(bench.sim().vehicle().collisions(), 0u);
  bench.setpoint(0xDF8, {4, 0, -1.5});
  bench.run(10s);
  EXPECT_EQ(bench.sim().vehicle().collisions(), 1u);
  EXPECT_EQ(journal.count("CRASH: hit a box"), 1u);
  EXPECT_LT(bench.truth().pose.position.x, 1.6 + 1e-9);
  EXPECT_GT(bench.truth().pose.position.x, 1.4);
}

TEST(SimAutopilotFaults, SpeaksOverASerialLineWithLittleRoom) {
  AutopilotBench bench({}, MemoryStreamKind::bytes);
  bench.line().limit_in_flight(64);
  bench.run(1s);
  EXPECT_GE(bench.count(peer::kHeartbeat), 1u);
  bench.line().limit_in_flight(64 * 1024);
  bench.fly();
  EXPECT_NEAR(bench.truth().pose.position.z, 1.5, 0.05);
  EXPECT_EQ(bench.parser().bad(), 0u);
  bench.line().drop();
  bench.run(3s);
  (void)bench.line().near().open();
  (void)bench.line().near().poll();
  const auto before = bench.count(peer::kHeartbeat);
  bench.run(3s);
  EXPECT_GE(bench.count(peer::kHeartbeat), before + 2);
}

TEST(SimAutopilotFaults, SpeaksMavlink1WhenAsked) {
  SimAutopilotConfig config;
  config.mavlink1 = true;
  AutopilotBench bench(config);
  bench.fly();
  EXPECT_TRUE(bench.last.at(peer::kHeartbeat.id).mavlink1);
  EXPECT_NEAR(bench.truth().pose.position.z, 1.5, 0.05);
}

}  // namespace
}  // namespace forager::mocks
