#include "reader/new_tag_counter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "hal/random.hpp"
#include "hal/units.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

// The laboratory's robot: port 4 looks ahead, 3 left, 1 back, 2 right.
std::vector<ReadPort> lab_ports() {
  return {{4, "front", 0.0, {}, {}},
          {3, "left", hal::kPi / 2, {}, {}},
          {1, "back", hal::kPi, {}, {}},
          {2, "right", -hal::kPi / 2, {}, {}}};
}

Epc epc(std::uint32_t number) {
  std::array<std::uint8_t, 12> bytes{0x30, 0x39};
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
  return Epc::from_bytes(bytes).value();
}

TagRead read_of(std::uint32_t tag, std::uint8_t port, hal::Duration heard) {
  TagRead read;
  read.epc = epc(tag);
  read.port = port;
  read.heard = hal::Instant(heard);
  return read;
}

double weight_of(std::span<const PortWeight> weights, std::uint8_t port) {
  for (const PortWeight& weight : weights)
    if (weight.port == port) return weight.weight;
  ADD_FAILURE() << "no weight for port " << int{port};
  return -1.0;
}

TEST(NewTagCounter, GivesOneWeightPerPlannedPortInPlanOrderWithItsBearing) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(1, 2, 10ms));
  counter.add(read_of(2, 2, 11ms));
  counter.add(read_of(3, 4, 12ms));
  const auto weights = counter.close_window();
  ASSERT_EQ(weights.size(), 4U);
  EXPECT_EQ(weights[0].port, 4);
  EXPECT_EQ(weights[0].weight, 1.0);
  EXPECT_EQ(weights[3].port, 2);
  EXPECT_EQ(weights[3].weight, 2.0);
  EXPECT_DOUBLE_EQ(weights[3].bearing_rad, -hal::kPi / 2);
  EXPECT_EQ(weights[1].weight, 0.0);
  EXPECT_EQ(counter.new_tags(), 3U);
  EXPECT_EQ(counter.counted(), 3U);
}

TEST(NewTagCounter, ATagIsNewOnlyOnce) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(7, 4, 10ms));
  counter.add(read_of(7, 4, 20ms));
  EXPECT_EQ(weight_of(counter.close_window(), 4), 1.0);
  counter.add(read_of(7, 1, 2s));
  EXPECT_EQ(weight_of(counter.close_window(), 1), 0.0);
  EXPECT_EQ(counter.new_tags(), 0U);
  EXPECT_EQ(counter.counted(), 1U);
}

TEST(NewTagCounter, TheAntennaThatHeardFirstGetsTheTagHoweverLateItsReadArrives) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(7, 4, 500ms));
  counter.add(read_of(7, 3, 120ms));  // arrives later, was heard earlier
  const auto weights = counter.close_window();
  EXPECT_EQ(weight_of(weights, 3), 1.0);
  EXPECT_EQ(weight_of(weights, 4), 0.0);
}

TEST(NewTagCounter, EqualTimesGoToTheLowerPortNumberNotToTheFirstInThePlan) {
  for (const bool swapped : {false, true}) {
    NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
    counter.add(read_of(7, swapped ? 1 : 4, 100ms));
    counter.add(read_of(7, swapped ? 4 : 1, 100ms));
    EXPECT_EQ(weight_of(counter.close_window(), 1), 1.0);
  }
}

TEST(NewTagCounter, SplitGivesEqualShares) {
  NewTagCounter counter(lab_ports(), ShareRule::split, 100);
  for (const std::uint8_t port : std::array<std::uint8_t, 4>{4, 3, 4, 2})
    counter.add(read_of(7, port, 100ms));
  counter.add(read_of(8, 4, 100ms));
  const auto weights = counter.close_window();
  EXPECT_DOUBLE_EQ(weight_of(weights, 4), 1.0 + 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(weight_of(weights, 3), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(weight_of(weights, 2), 1.0 / 3.0);
  EXPECT_EQ(weight_of(weights, 1), 0.0);
  EXPECT_EQ(counter.new_tags(), 2U);
}

TEST(NewTagCounter, TagsOfAnUndecidedWindowCarryOverWithTheAntennaThatHeardThemFirst) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(1, 4, 100ms));
  counter.add(read_of(2, 1, 110ms));
  (void)counter.close_window();  // front and back cancel: no decision
  counter.reopen();
  EXPECT_EQ(counter.counted(), 0U);
  EXPECT_EQ(counter.new_tags(), 0U);
  counter.add(read_of(1, 3, 2100ms));  // heard again, later, elsewhere
  counter.add(read_of(3, 3, 2200ms));
  const auto weights = counter.close_window();
  EXPECT_EQ(weight_of(weights, 4), 1.0);
  EXPECT_EQ(weight_of(weights, 1), 1.0);
  EXPECT_EQ(weight_of(weights, 3), 1.0);
  EXPECT_EQ(counter.new_tags(), 3U);
  EXPECT_EQ(counter.counted(), 3U);
}

TEST(NewTagCounter, AReadBetweenCloseAndReopenCanStillShowWhoWasFirst) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(1, 4, 1900ms));
  (void)counter.close_window();
  counter.add(read_of(1, 2, 1500ms));
  counter.reopen();
  EXPECT_EQ(weight_of(counter.close_window(), 2), 1.0);
}

TEST(NewTagCounter, OnlyTheLastWindowCanBeTakenBackAndOnlyOnce) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(1, 4, 1s));
  (void)counter.close_window();
  counter.add(read_of(2, 4, 3s));
  (void)counter.close_window();
  counter.reopen();
  counter.reopen();
  EXPECT_EQ(counter.counted(), 1U);
  (void)counter.close_window();
  EXPECT_EQ(counter.new_tags(), 1U);
  EXPECT_EQ(counter.counted(), 2U);
}

TEST(NewTagCounter, KnownTagsAreNeverNewWheneverTheyAreMarked) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.mark_known(epc(1));
  counter.add(read_of(1, 4, 1s));
  counter.add(read_of(2, 4, 1s));
  counter.mark_known(epc(2));
  counter.add(read_of(3, 4, 1s));
  EXPECT_EQ(weight_of(counter.close_window(), 4), 1.0);
  EXPECT_EQ(counter.counted(), 1U);
}

TEST(NewTagCounter, ReadsOfUnplannedPortsMoveNothingAndAreCounted) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 100);
  counter.add(read_of(1, 7, 1s));
  counter.add(read_of(1, 0, 1s));
  (void)counter.close_window();
  EXPECT_EQ(counter.strangers(), 2U);
  EXPECT_EQ(counter.new_tags(), 0U);
  counter.add(read_of(1, 4, 3s));
  (void)counter.close_window();
  EXPECT_EQ(counter.new_tags(), 1U) << "a stranger's read must not make a tag old";
}

TEST(NewTagCounter, AllocatesNothingWhileWithinTheExpectedTags) {
  constexpr std::size_t kTags = 1700;
  for (const ShareRule rule : {ShareRule::first_heard, ShareRule::split}) {
    NewTagCounter counter(lab_ports(), rule, kTags);
    hal::Random random(5);
    const std::uint64_t before = test::allocation_count();
    for (int window = 0; window < 200; ++window) {
      for (int i = 0; i < 80; ++i)
        counter.add(read_of(static_cast<std::uint32_t>(random.below(kTags)),
                            static_cast<std::uint8_t>(1 + random.below(4)), 1ms * random.below(2000)));
      (void)counter.close_window();
      if (window % 3 == 0) counter.reopen();
    }
    EXPECT_EQ(test::allocation_count(), before);
    EXPECT_GT(counter.counted(), kTags / 2);
  }
}

TEST(NewTagCounter, OutgrowingTheExpectationCostsMemoryNotCorrectness) {
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 4);
  for (std::uint32_t tag = 0; tag < 5000; ++tag) counter.add(read_of(tag, 4, 1s));
  EXPECT_EQ(weight_of(counter.close_window(), 4), 5000.0);
  for (std::uint32_t tag = 0; tag < 5000; ++tag) counter.add(read_of(tag, 4, 3s));
  (void)counter.close_window();
  EXPECT_EQ(counter.new_tags(), 0U);
}

// Shuffling the reads of a window changes no weight by a single bit.
RC_GTEST_PROP(NewTagCounterProperty, WeightsDoNotDependOnTheOrderOfArrival,
              (bool split, std::uint64_t seed)) {
  hal::Random random(seed);
  std::vector<TagRead> reads;
  for (std::uint64_t n = random.below(200); n > 0; --n)
    reads.push_back(read_of(static_cast<std::uint32_t>(random.below(40)),
                            static_cast<std::uint8_t>(1 + random.below(5)), 1ms * random.below(30)));
  const ShareRule rule = split ? ShareRule::split : ShareRule::first_heard;
  NewTagCounter in_order(lab_ports(), rule, 64);
  for (const TagRead& read : reads) in_order.add(read);
  for (std::size_t i = reads.size(); i > 1; --i) std::swap(reads[i - 1], reads[random.below(i)]);
  NewTagCounter shuffled(lab_ports(), rule, 64);
  for (const TagRead& read : reads) shuffled.add(read);
  const auto a = in_order.close_window();
  const auto b = shuffled.close_window();
  for (std::size_t i = 0; i < a.size(); ++i) RC_ASSERT(a[i].weight == b[i].weight);
}

// Against a plain model over many windows: every tag is counted exactly once, for the right port, and the
// weights of a window add up to its new tags.
RC_GTEST_PROP(NewTagCounterProperty, CountsEveryTagOnceOverAnyRunOfWindows, (std::uint64_t seed)) {
  hal::Random random(seed);
  NewTagCounter counter(lab_ports(), ShareRule::first_heard, 16);
  std::set<std::uint32_t> counted;
  std::map<std::uint32_t, std::pair<int, int>> fresh;  // tag -> earliest (time, port)
  for (int window = 0; window < 12; ++window) {
    for (std::uint64_t n = random.below(60); n > 0; --n) {
      const auto tag = static_cast<std::uint32_t>(random.below(120));
      const auto port = static_cast<int>(1 + random.below(4));
      const auto at = static_cast<int>(random.below(50)) + 40 * window;
      counter.add(read_of(tag, static_cast<std::uint8_t>(port), 1ms * at));
      if (counted.count(tag) != 0) continue;
      const auto [seen, added] = fresh.try_emplace(tag, at, port);
      if (!added) seen->second = std::min(seen->second, std::pair(at, port));
    }
    std::map<int, double> expected;
    for (const auto& [tag, first] : fresh) expected[first.second] += 1.0;
    const auto weights = counter.close_window();
    RC_ASSERT(counter.new_tags() == fresh.size());
    for (const PortWeight& weight : weights) RC_ASSERT(weight.weight == expected[weight.port]);
    if (random.chance(0.3)) {
      counter.reopen();
    } else {
      for (const auto& [tag, first] : fresh) counted.insert(tag);
      fresh.clear();
    }
    RC_ASSERT(counter.counted() == counted.size());
  }
}

}  // namespace
}  // namespace forager::reader
