#include <gtest/gtest.h>

#include "tests/mocks/autopilot_client.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

TEST(SimAutopilotAllocation, AFlightAllocatesNothing) {
  AutopilotBench bench;
  bench.fly();
  for (const auto& kind :
       {peer::kAttitude, peer::kLocalPositionNed, peer::kSysStatus, peer::kExtendedSysState})
    bench.stream(kind, 10);
  hal::Instant now = bench.now();
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 1000; ++i) {
    now += 20ms;
    bench.send_vision();
    bench.setpoint(0x9F8, {1, 0, -1.5});
    bench.sim().update(now);
  }
  EXPECT_EQ(test::allocation_count() - before, 0u);
  EXPECT_NEAR(bench.truth().pose.position.x, 1.0, 0.02);
}

}  // namespace
}  // namespace forager::mocks
