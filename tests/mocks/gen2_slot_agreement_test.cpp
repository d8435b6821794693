// The round-level field against the slot-level one, which it approximates.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mocks/gen2_field.hpp"
#include "mocks/gen2_slot_field.hpp"
#include "tests/mocks/field_bench.hpp"

namespace forager::mocks {
namespace {

struct Totals {
  double reads_per_s = 0.0;
  std::array<double, 3> unique{};  // after 1, 3 and 10 s
};
constexpr std::array<double, 3> kAfter_s = {1.0, 3.0, 10.0};

class Agreement : public ::testing::TestWithParam<int>, protected FieldBench {
 protected:
  template <class Make>
  Totals mean(int seeds, Make&& make) {
    Totals total;
    for (int seed = 0; seed < seeds; ++seed) {
      now = hal::Instant{};
      auto field = make(static_cast<std::uint64_t>(seed));
      const auto reads = listen(field, kAfter_s.back(), kAfter_s.back());
      total.reads_per_s += static_cast<double>(reads.size()) / kAfter_s.back() / seeds;
      for (std::size_t i = 0; i < kAfter_s.size(); ++i)
        total.unique[i] += static_cast<double>(unique(reads, kAfter_s[i])) / seeds;
    }
    return total;
  }
  // Both models within `tolerance`, and what chance adds.
  void expect_agreement(double tolerance) {
    const SlotParameters slots;
    const RoundParameters derived = round_parameters(slots);
    air.singulation_s = derived.singulation_s;
    air.round_s = derived.round_s;
    for (const int tags : {1, 16, 64, 256, 1000}) {
      SCOPED_TRACE(std::to_string(tags) + " tags");
      world.tags = {};
      tags_in_view(tags);
      const int seeds = std::clamp(2000 / tags, 6, 400);
      const Totals rounds =
          mean(seeds, [&](std::uint64_t seed) { return SimTagField(world, body, antennas, air, seed); });
      const Totals slot = mean(
          seeds, [&](std::uint64_t seed) { return SlotTagField(world, body, antennas, air, slots, seed); });
      const auto near = [&](double a, double b, double counted, const char* what) {
        // Counts of independent runs: four deviations of their difference at most.
        const double chance = 4.0 * std::sqrt(2.0 * counted * seeds) / (counted * seeds);
        EXPECT_NEAR(a / b, 1.0, tolerance + chance) << what << ": rounds " << a << ", slots " << b;
      };
      near(rounds.reads_per_s, slot.reads_per_s, 10.0 * slot.reads_per_s, "reads/s");
      for (std::size_t i = 0; i < kAfter_s.size(); ++i)
        near(rounds.unique[i], slot.unique[i], slot.unique[i], "unique tags");
    }
  }
};

// A single antenna: 3 %. Four in turn: 10 %, for the visits of the slot-level reader consist of whole rounds.
TEST_P(Agreement, OfReadsAndTagsWithOneAntenna) {
  settings.session = GetParam();
  expect_agreement(0.03);
}
TEST_P(Agreement, OfReadsAndTagsWithFourAntennasInTurn) {
  settings.session = GetParam();
  four_ports();
  expect_agreement(0.10);
}
INSTANTIATE_TEST_SUITE_P(Sessions, Agreement, ::testing::Values(0, 1, 2));

TEST(RoundParameters, FollowTheLink) {
  SlotParameters slow;
  SlotParameters fast;
  fast.link = {.tari_us = 6.25, .pie = 1.5, .blf_khz = 640.0, .m = 1};
  const RoundParameters a = round_parameters(slow);
  const RoundParameters b = round_parameters(fast);
  // One success, and 0.7 to 1 collisions a tag (Q algorithm, 16 to 1000 tags).
  for (const auto& [p, slots] : {std::pair{a, slow}, std::pair{b, fast}}) {
    const SlotTimes t = slot_times(slots.link);
    EXPECT_GT(1e6 * p.singulation_s, t.success_us + 0.6 * t.collided_us);
    EXPECT_LT(1e6 * p.singulation_s, t.success_us + 1.3 * t.collided_us);
    EXPECT_GT(p.round_s, slots.round_overhead_s + 1e-6 * (t.query_us + 10.0 * t.empty_us));
  }
  EXPECT_GT(a.singulation_s, 5.0 * b.singulation_s);
  EXPECT_EQ(round_parameters(slow).singulation_s, a.singulation_s);
}

}  // namespace
}  // namespace forager::mocks
