#include "flight/mavlink_setpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/flight/mavlink_bench_autopilot.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::AutopilotBench;
namespace peer = mocks::peer;

TEST(MavlinkSetpoint, SendsPositionsInLocalNedWithYawUntilTheyRunOut) {
  AutopilotBench bench;
  bench.connect();
  bench.ours().set_position({{1, 2, 3}, 0.5, bench.now() + 1s});
  bench.step();
  EXPECT_EQ(bench.heard(peer::kSetPositionTargetLocalNed).size(), 1U) << "a new goal goes out at once";
  bench.run(3s);
  const auto targets = bench.heard(peer::kSetPositionTargetLocalNed);
  ASSERT_EQ(targets.size(), 10U);
  const auto& p = targets[0].payload;
  EXPECT_EQ(p.get<std::uint16_t>(48), 0x09F8);
  EXPECT_EQ(p.get<std::uint8_t>(52), 1);
  EXPECT_EQ(p.get<float>(4), 1.0F);
  EXPECT_EQ(p.get<float>(8), -2.0F);
  EXPECT_EQ(p.get<float>(12), -3.0F);
  EXPECT_EQ(p.get<float>(40), -0.5F);
  EXPECT_EQ(p.get<std::uint8_t>(50), 1);
  EXPECT_EQ(p.get<std::uint8_t>(51), 1);
  EXPECT_EQ(bench.journal().count("setpoint ran out"), 1U);
}

TEST(MavlinkSetpoint, SendsVelocitiesInTheBodyFrameWithYawRate) {
  AutopilotBench bench;
  bench.connect();
  bench.ours().set_velocity({{0.5, 0.25, 0.125}, 0.75, bench.now() + 1s});
  bench.step();
  const auto targets = bench.heard(peer::kSetPositionTargetLocalNed);
  ASSERT_EQ(targets.size(), 1U);
  const auto& p = targets[0].payload;
  EXPECT_EQ(p.get<std::uint16_t>(48), 0x05C7);
  EXPECT_EQ(p.get<std::uint8_t>(52), 8);
  EXPECT_EQ(p.get<float>(16), 0.5F);
  EXPECT_EQ(p.get<float>(20), -0.25F);
  EXPECT_EQ(p.get<float>(24), -0.125F);
  EXPECT_EQ(p.get<float>(44), -0.75F);
}

TEST(MavlinkSetpoint, ALoopThatRenewsItsGoalEachTurnDoesNotFloodTheLine) {
  AutopilotBench bench;
  bench.connect();
  for (int i = 0; i < 100; ++i) {  // 2 s at 50 Hz
    bench.ours().set_position({{1, 2, 3}, 0.5, bench.now() + 300ms});
    bench.step();
  }
  EXPECT_NEAR(static_cast<double>(bench.heard(peer::kSetPositionTargetLocalNed).size()), 20.0, 1.0);
}

TEST(MavlinkSetpoint, SendsNoSetpointOutsideGuidedNorAnyThatIsNotFinite) {
  AutopilotBench bench;
  bench.connect();
  bench.mode(5);
  bench.run(2s);
  bench.ours().set_position({{1, 2, 3}, 0.0, bench.now() + 1h});
  bench.run(1s);
  EXPECT_TRUE(bench.heard(peer::kSetPositionTargetLocalNed).empty());
  bench.mode(4);
  bench.run(1200ms);
  EXPECT_FALSE(bench.heard(peer::kSetPositionTargetLocalNed).empty());
  bench.ours().set_position({{std::nan(""), 2, 3}, 0.0, bench.now() + 1h});
  bench.clear();
  bench.run(1s);
  EXPECT_TRUE(bench.heard(peer::kSetPositionTargetLocalNed).empty());
  EXPECT_EQ(bench.journal().count("not finite"), 1U);
}

}  // namespace
}  // namespace forager::flight
