#include "tools/paired_times.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hal/random.hpp"

namespace forager::tools {
namespace {

using boards::OverheadContest;

std::vector<TimedPair> pairs_of(const std::vector<double>& ratios) {
  std::vector<TimedPair> pairs;
  pairs.reserve(ratios.size());
  for (const double ratio : ratios) pairs.push_back({100.0 * ratio, 100.0, 90.0 * ratio, 90.0});
  return pairs;
}

TEST(PairedFigures, OneInterruptedPairChangesNothing) {
  std::vector<double> ratios(101, 1.02);
  ratios[7] = 40.0;
  const PairedFigures figures = figures_of(pairs_of(ratios));
  EXPECT_DOUBLE_EQ(figures.ratio.median, 1.02);
  EXPECT_DOUBLE_EQ(figures.ratio_high, 1.02);
  EXPECT_NEAR(figures.added_ns, 2.0, 1e-9);
  EXPECT_NEAR(figures.ours_ns, 102.0, 1e-9);
  EXPECT_NEAR(figures.ours_cpu_ns, 91.8, 1e-9);
  EXPECT_EQ(figures.pairs, 101U);
}

// Both sides a hundred times slower in the second half: the ratio of pairs does not care.
TEST(PairedFigures, DriftOfTheMachineCancels) {
  std::vector<TimedPair> pairs;
  for (int i = 0; i < 100; ++i) {
    const double slow = i < 50 ? 1.0 : 100.0;
    pairs.push_back({103.0 * slow, 100.0 * slow, 0.0, 0.0});
  }
  const PairedFigures figures = figures_of(pairs);
  EXPECT_NEAR(figures.ratio.p5, 1.03, 1e-9);
  EXPECT_NEAR(figures.ratio.p95, 1.03, 1e-9);
}

TEST(PairedFigures, AFewPairsGiveTheirWholeRange) {
  const PairedFigures one = figures_of(pairs_of({1.5}));
  EXPECT_DOUBLE_EQ(one.ratio.median, 1.5);
  EXPECT_DOUBLE_EQ(one.ratio_low, 1.5);
  EXPECT_DOUBLE_EQ(one.ratio_high, 1.5);
  const PairedFigures three = figures_of(pairs_of({1.0, 3.0, 2.0}));
  EXPECT_DOUBLE_EQ(three.ratio_low, 1.0);
  EXPECT_DOUBLE_EQ(three.ratio_high, 3.0);
}

// Log-normal ratios with a median of exactly one: the interval holds it in 95 of 100 experiments.
TEST(PairedFigures, TheIntervalHoldsTheMedianAsOftenAsItSays) {
  hal::Random random(1);
  for (const std::size_t size : {21U, 100U, 1001U}) {
    int held = 0;
    constexpr int kExperiments = 1000;
    for (int i = 0; i < kExperiments; ++i) {
      std::vector<double> ratios(size);
      for (double& ratio : ratios) ratio = std::exp(0.1 * random.normal());
      const PairedFigures figures = figures_of(pairs_of(ratios));
      held += figures.ratio_low <= 1.0 && 1.0 <= figures.ratio_high ? 1 : 0;
    }
    EXPECT_GE(held, 0.93 * kExperiments) << size;
    EXPECT_LE(held, 0.99 * kExperiments) << size;
  }
}

// What is open when, and how often it was called.
struct Ledger {
  int open = 0;
  int most_open = 0;
  std::string order;
  std::vector<std::uint64_t> calls;
};

OverheadContest ledger_contest(Ledger& ledger) {
  const auto side = [&ledger](char name) {
    return [&ledger, name]() -> hal::Result<OverheadContest::Side> {
      ledger.order += name;
      ledger.most_open = std::max(ledger.most_open, ++ledger.open);
      const std::shared_ptr<void> held(nullptr, [&ledger](void*) { --ledger.open; });
      return OverheadContest::Side([&ledger, held](std::uint64_t calls) -> hal::Result<std::uint64_t> {
        ledger.calls.push_back(calls);
        return calls;
      });
    };
  };
  return {.name = "ledger",
          .ours = "ours",
          .bare = "bare",
          .unit = "call",
          .batch = std::chrono::nanoseconds(1),
          .open_ours = side('o'),
          .open_bare = side('b')};
}

TEST(TimePairs, SidesTakeTurnsAndNeverHoldADeviceTogether) {
  Ledger ledger;
  const auto pairs = time_pairs(ledger_contest(ledger), {.seconds = 0.0, .least = 4});
  ASSERT_TRUE(pairs);
  EXPECT_EQ(pairs->size(), 4U);
  EXPECT_EQ(ledger.order, "oobboobbo") << "one to find the number of calls, then pairs";
  EXPECT_EQ(ledger.most_open, 1);
  EXPECT_EQ(ledger.open, 0);
  for (const std::uint64_t calls : ledger.calls)
    EXPECT_EQ(calls % 2, 0U) << "what is toggled ends as it began";
}

TEST(TimePairs, AnErrorOfASideIsTheResultAndAStopEndsIt) {
  Ledger ledger;
  OverheadContest contest = ledger_contest(ledger);
  const auto stopped =
      time_pairs(contest, {.seconds = 60.0, .stop = [&] { return ledger.order.size() > 5; }});
  ASSERT_TRUE(stopped);
  EXPECT_EQ(stopped->size(), 3U);
  contest.open_bare = [] { return hal::fail(hal::ErrorCode::busy, "line", "open", "held"); };
  const auto failed = time_pairs(contest, {.seconds = 0.0});
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, hal::ErrorCode::busy);
}

}  // namespace
}  // namespace forager::tools
