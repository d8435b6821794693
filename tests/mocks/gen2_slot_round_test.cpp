#include "mocks/gen2_slot_round.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

#include "mocks/gen2_slot_tag.hpp"
#include "mocks/gen2_timing.hpp"
#include "tests/mocks/gen2_table.hpp"

namespace forager::mocks {
namespace {

struct Inventory {
  double us = 0.0;
  std::array<double, 3> slots{};  // empty, single, collided
};

double opening_us(SlotCommand command, const SlotTimes& s) {
  return command == SlotCommand::query          ? s.query_us
         : command == SlotCommand::query_adjust ? s.query_adjust_us
                                                : s.query_rep_us;
}

// A reader that knows when the last tag was read.
Inventory inventory(SlotRound& round, std::uint32_t tags, QAlgorithm q, const SlotTimes& s,
                    hal::Random& random) {
  Inventory total;
  round.clear();
  for (std::uint32_t i = 0; i < tags; ++i) round.join(i);
  round.start(q);
  while (round.tags_left() > 0) {
    total.us += opening_us(round.command(), s) - s.query_rep_us;
    const std::size_t replies = round.open_slot(random).size();
    total.slots[std::min<std::size_t>(replies, 2)] += 1.0;
    if (replies == 0) {
      total.us += s.empty_us;
      round.heard_nothing();
    } else if (replies == 1) {
      total.us += s.success_us;
      round.heard_one(0);
    } else {
      total.us += s.collided_us;
      round.heard_collision();
    }
  }
  return total;
}

Inventory mean_inventory(std::uint32_t tags, QAlgorithm q, const SlotTimes& s, int runs) {
  SlotRound round(tags);
  hal::Random random(tags + 7);
  Inventory mean;
  for (int i = 0; i < runs; ++i) {
    const Inventory one = inventory(round, tags, q, s, random);
    mean.us += one.us / runs;
    for (std::size_t k = 0; k < 3; ++k) mean.slots[k] += one.slots[k] / runs;
  }
  return mean;
}

TEST(SlotRound, TheQAlgorithmTakesThePublishedTime) {
  int rows = 0;
  for (const TableRow& row : gen2_table("q_algorithm.csv")) {
    const SlotTimes slots = slot_times({.tari_us = number(row, "tari"),
                                        .pie = number(row, "pie"),
                                        .blf_khz = number(row, "blf"),
                                        .m = static_cast<int>(number(row, "m"))});
    const auto tags = static_cast<std::uint32_t>(number(row, "tags"));
    SCOPED_TRACE("row " + std::to_string(++rows) + ", tags " + row.at("tags"));
    // The duration of one run scatters by some 30 % / sqrt(tags): a tenth of the tolerance remains.
    const int runs = tags < 16 ? 20000 : tags < 100 ? 4000 : 500;
    const Inventory mean = mean_inventory(tags, {4.0, number(row, "c")}, slots, runs);
    // One decimal of ms is coarser than 2 % for a single tag: there the rate decides.
    const double printed_us =
        number(row, "rate") > 0.0 ? 1e6 * tags / number(row, "rate") : 1e3 * number(row, "ms");
    EXPECT_NEAR(mean.us, printed_us, 0.02 * printed_us);
    if (number(row, "single") == 0.0) continue;
    EXPECT_EQ(std::lround(mean.slots[1]), std::lround(number(row, "single")));
    for (const auto& [k, column] : {std::pair{0U, "empty"}, std::pair{2U, "collided"}})
      EXPECT_NEAR(mean.slots[k], number(row, column), 0.6 + 0.03 * number(row, column)) << column;
  }
  EXPECT_EQ(rows, 23);
}

TEST(SlotRound, EveryTagIsReadOnceAndTheReaderNoticesTheEnd) {
  hal::Random random(3);
  SlotRound round(300);
  for (const std::uint32_t tags : {0U, 1U, 2U, 17U, 300U})
    for (const QAlgorithm q : {QAlgorithm{4.0, 0.3}, QAlgorithm{0.0, 0.5}, QAlgorithm{6.0, 0.0}}) {
      round.clear();
      for (std::uint32_t i = 0; i < tags; ++i) round.join(i);
      round.start(q);
      std::set<std::uint32_t> read;
      int slots = 0;
      while (!round.over()) {
        ASSERT_LT(++slots, 200000);
        const auto answer = round.open_slot(random);
        if (answer.empty()) {
          round.heard_nothing();
        } else if (answer.size() == 1) {
          ASSERT_TRUE(read.insert(answer[0]).second);
          round.heard_one(0);
        } else {
          round.heard_collision();
        }
      }
      EXPECT_EQ(read.size(), tags);
      EXPECT_EQ(round.tags_left(), 0U);
    }
}

TEST(SlotRound, ACapturedTagLeavesTheOthersForLater) {
  hal::Random random(3);
  SlotRound round(3);
  for (std::uint32_t i = 0; i < 3; ++i) round.join(i);
  round.start({0.0, 0.3});  // one slot: all three answer
  auto answer = round.open_slot(random);
  ASSERT_EQ(answer.size(), 3U);
  const std::set<std::uint32_t> drowned{answer[0], answer[2]};
  round.heard_one(1);
  EXPECT_FALSE(round.over());
  EXPECT_EQ(round.command(), SlotCommand::query);
  answer = round.open_slot(random);
  EXPECT_EQ(std::set<std::uint32_t>(answer.begin(), answer.end()), drowned);
}

TEST(SlotRound, AFixedQIsNotAdjusted) {
  hal::Random random(3);
  SlotRound round(100);
  for (std::uint32_t i = 0; i < 100; ++i) round.join(i);
  round.start({5.0, 0.0});
  for (int slot = 0; slot < 320; ++slot) {
    EXPECT_EQ(round.command(), slot % 32 == 0 ? SlotCommand::query : SlotCommand::query_rep);
    const auto answer = round.open_slot(random);
    if (answer.size() == 1) {
      round.heard_one(0);
    } else if (answer.empty()) {
      round.heard_nothing();
    } else {
      round.heard_collision();
    }
    if (round.over()) break;
  }
  EXPECT_EQ(round.q().q(), 5);
}

// The same reader with tags that follow the standard command by command.
Inventory standard_inventory(std::uint32_t tags, QAlgorithm q, const SlotTimes& s, std::uint64_t seed) {
  SessionFlags flags(tags, AirParameters{}, 1);
  std::vector<SlotTag> all;
  for (std::uint32_t i = 0; i < tags; ++i) {
    all.emplace_back(flags, i, 1000 * seed + i);
    all.back().power_on(0.0, 1);
  }
  Inventory total;
  SlotCommand command = SlotCommand::query;
  int frame_q = q.q();
  std::uint32_t slots_left = 0;
  Gen2UpDn change = Gen2UpDn::same;
  std::uint32_t left = tags;
  while (left > 0) {
    total.us += opening_us(command, s) - s.query_rep_us;
    if (command != SlotCommand::query_rep) slots_left = 1U << frame_q;
    std::vector<SlotTag*> replies;
    for (SlotTag& tag : all) {
      const TagReply reply = command == SlotCommand::query
                                 ? tag.query({.session = 2, .q = static_cast<std::uint8_t>(frame_q)}, 0.0)
                             : command == SlotCommand::query_adjust ? tag.query_adjust(2, change, 0.0)
                                                                    : tag.query_rep(2, 0.0);
      if (reply == TagReply::rn16) replies.push_back(&tag);
    }
    total.slots[std::min<std::size_t>(replies.size(), 2)] += 1.0;
    if (replies.empty()) {
      total.us += s.empty_us;
      q.empty();
    } else if (replies.size() > 1) {
      total.us += s.collided_us;
      q.collided();
    } else {
      total.us += s.success_us;
      EXPECT_EQ(replies[0]->ack(replies[0]->rn16()), TagReply::epc);
      --left;
    }
    --slots_left;
    change = q.q() > frame_q ? Gen2UpDn::up : Gen2UpDn::down;
    command = q.q() != frame_q  ? SlotCommand::query_adjust
              : slots_left == 0 ? SlotCommand::query
                                : SlotCommand::query_rep;
    frame_q = q.q();
  }
  return total;
}

TEST(SlotRound, IsWhatTagsOfTheStandardDo) {
  const SlotTimes s = slot_times({});
  for (const std::uint32_t tags : {1U, 5U, 40U}) {
    const int runs = tags > 10 ? 600 : 3000;
    Inventory standard;
    double square = 0.0;
    for (int i = 0; i < runs; ++i) {
      const Inventory one = standard_inventory(tags, {4.0, 0.3}, s, static_cast<std::uint64_t>(i));
      standard.us += one.us / runs;
      square += one.us * one.us / runs;
      for (std::size_t k = 0; k < 3; ++k) standard.slots[k] += one.slots[k] / runs;
    }
    const Inventory fast = mean_inventory(tags, {4.0, 0.3}, s, runs);
    const double deviation = std::sqrt(std::max(square - standard.us * standard.us, 0.0) * 2.0 / runs);
    EXPECT_NEAR(fast.us, standard.us, 4.0 * deviation) << tags;
    EXPECT_NEAR(fast.slots[0], standard.slots[0], 0.05 * tags + 0.4);
    EXPECT_NEAR(fast.slots[2], standard.slots[2], 0.05 * tags);
  }
}

}  // namespace
}  // namespace forager::mocks
