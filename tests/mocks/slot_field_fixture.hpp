#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "mocks/gen2_slot_field.hpp"
#include "tests/mocks/field_bench.hpp"

namespace forager::mocks {

// A slot-level field with tags laid out by hand.
class SlotTagFieldTest : public testing::Test, protected FieldBench {
 protected:
  SlotTagField field(std::uint64_t seed = 1) {
    const auto valid = validate(slots, air);
    EXPECT_TRUE(valid) << describe(valid.error());
    return {world, body, antennas, air, slots, seed};
  }
  std::vector<AirRead> fresh(double seconds, double tick = 0.1, std::uint64_t seed = 1) {
    now = hal::Instant{};
    SlotTagField f = field(seed);
    auto reads = listen(f, seconds, tick);
    statistics = f.statistics();
    return reads;
  }
  // Share of runs that read a lone tag within T0.
  double heard_within_t0(int runs, double tick) {
    int heard = 0;
    for (int run = 0; run < runs; ++run)
      heard += fresh(air.t0_s, tick, static_cast<std::uint64_t>(run)).empty() ? 0 : 1;
    return static_cast<double>(heard) / runs;
  }

  SlotParameters slots;
  SlotStatistics statistics;
};

}  // namespace forager::mocks
