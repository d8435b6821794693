#include "mocks/gen2_timing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/mocks/gen2_table.hpp"

namespace forager::mocks {
namespace {

// The tables print one decimal: half of it, and rounding of the last bit.
constexpr double kPrinted_us = 0.0501;

constexpr LinkProfile kFast{.tari_us = 6.25, .pie = 1.5, .blf_khz = 640.0, .m = 1};
constexpr LinkProfile kDense{.tari_us = 20.0, .pie = 2.0, .blf_khz = 274.0, .m = 4};

TEST(Gen2Timing, TheTwoBestKnownLinks) {
  const SlotTimes fast = slot_times(kFast);
  EXPECT_NEAR(fast.empty_us, 90.6, kPrinted_us);
  EXPECT_NEAR(fast.collided_us, 126.6, kPrinted_us);
  EXPECT_NEAR(fast.success_us, 543.8, kPrinted_us);
  const SlotTimes dense = slot_times(kDense);
  EXPECT_NEAR(dense.empty_us, 292.5, kPrinted_us);
  EXPECT_NEAR(dense.collided_us, 663.2, kPrinted_us);
  EXPECT_NEAR(dense.success_us, 3421.4, kPrinted_us);
}

// The link of a row: the first PIE for which a conforming reader could use it.
bool legal_link(LinkProfile& link) {
  for (const double pie : {1.5, 1.75, 2.0}) {
    link.pie = pie;
    if (validate(link)) return true;
  }
  return false;
}

void expect_rates(const SlotTimes& slots, const TableRow& row) {
  EXPECT_NEAR(aloha_rate(slots, 1.0), number(row, "rate_at_1"), 0.51);
  EXPECT_NEAR(aloha_rate(slots, best_replies_per_slot(slots)), number(row, "rate_at_best"), 0.51);
  EXPECT_NEAR(best_replies_per_slot(slots), number(row, "best"), 0.0101);
  EXPECT_NEAR(1e6 / slots.success_us, number(row, "ceiling"), 0.51);
}

TEST(Gen2Timing, EveryCombinationOfRates) {
  int legal = 0;
  int illegal = 0;
  for (const TableRow& row : gen2_table("slots.csv")) {
    LinkProfile link{.tari_us = number(row, "tari"),
                     .blf_khz = number(row, "blf"),
                     .m = static_cast<int>(number(row, "m"))};
    SCOPED_TRACE("Tari " + row.at("tari") + " BLF " + row.at("blf") + " M " + row.at("m"));
    ASSERT_EQ(legal_link(link), row.at("legal") == "yes");
    if (row.at("legal") != "yes") {
      ++illegal;
      continue;
    }
    ++legal;
    const LinkTimes times = link_times(link);
    const SlotTimes slots = slot_times(link);
    EXPECT_NEAR(times.rtcal_us, number(row, "rtcal"), kPrinted_us);
    EXPECT_NEAR(times.trcal_us, number(row, "trcal"), kPrinted_us);
    EXPECT_EQ(times.dr_64_3, row.at("dr") == "64/3");
    EXPECT_NEAR(times.t1_us, number(row, "t1"), kPrinted_us);
    EXPECT_NEAR(times.t2_us, number(row, "t2"), kPrinted_us);
    EXPECT_NEAR(slots.query_rep_us, number(row, "query_rep"), kPrinted_us);
    EXPECT_NEAR(slots.rn16_us, number(row, "rn16"), kPrinted_us);
    EXPECT_NEAR(slots.ack_us, number(row, "ack"), kPrinted_us);
    EXPECT_NEAR(slots.epc_us, number(row, "epc"), kPrinted_us);
    EXPECT_NEAR(slots.empty_us, number(row, "empty"), kPrinted_us);
    EXPECT_NEAR(slots.collided_us, number(row, "collided"), kPrinted_us);
    EXPECT_NEAR(slots.success_us, number(row, "success"), kPrinted_us);
    expect_rates(slots, row);
  }
  EXPECT_EQ(legal, 40);
  EXPECT_EQ(illegal, 20);
}

TEST(Gen2Timing, EveryModeOfRealReaders) {
  int rows = 0;
  for (const TableRow& row : gen2_table("modes.csv")) {
    const LinkProfile link{.tari_us = number(row, "tari"),
                           .pie = number(row, "pie"),
                           .blf_khz = number(row, "blf"),
                           .m = static_cast<int>(number(row, "m")),
                           .trext = row.at("trext") == "1"};
    SCOPED_TRACE("row " + std::to_string(++rows));
    ASSERT_TRUE(validate(link));
    const LinkTimes times = link_times(link);
    const SlotTimes slots = slot_times(link);
    EXPECT_NEAR(times.frame_sync_us, number(row, "frame_sync"), kPrinted_us);
    EXPECT_NEAR(times.preamble_us, number(row, "preamble"), kPrinted_us);
    EXPECT_NEAR(slots.query_rep_us, number(row, "query_rep"), kPrinted_us);
    EXPECT_NEAR(slots.query_adjust_us, number(row, "query_adjust"), kPrinted_us);
    EXPECT_NEAR(slots.query_us, number(row, "query"), kPrinted_us);
    EXPECT_NEAR(slots.ack_us, number(row, "ack"), kPrinted_us);
    EXPECT_NEAR(slots.nak_us, number(row, "nak"), kPrinted_us);
    EXPECT_NEAR(slots.rn16_us, number(row, "rn16"), kPrinted_us);
    EXPECT_NEAR(slots.epc_us, number(row, "epc"), kPrinted_us);
    EXPECT_NEAR(slots.empty_us, number(row, "empty"), kPrinted_us);
    EXPECT_NEAR(slots.collided_us, number(row, "collided"), kPrinted_us);
    EXPECT_NEAR(slots.success_us, number(row, "success"), kPrinted_us);
    expect_rates(slots, row);
  }
  EXPECT_EQ(rows, 18);
}

TEST(Gen2Timing, ACommandLastsAsLongAsItsBits) {
  const LinkTimes t = link_times(kFast);
  EXPECT_DOUBLE_EQ(t.command_us(encode_query_rep(0)), t.frame_sync_us + 4 * 6.25);
  EXPECT_DOUBLE_EQ(t.command_us(encode_query_rep(3)), t.frame_sync_us + 2 * 6.25 + 2 * 9.375);
  EXPECT_DOUBLE_EQ(t.query_us(encode_query({.q = 0})) - t.command_us(encode_query({.q = 0})), t.trcal_us);
}

TEST(Gen2Timing, AnAcknowledgedReplyThatIsLostCostsTheAckAndTheSilence) {
  const SlotTimes s = slot_times(kDense);
  EXPECT_NEAR(s.ack_no_epc_us, s.collided_us + s.ack_us + 2.0 * 60.0, 1e-9);  // T4 = 2 RTcal
  EXPECT_LT(s.ack_no_epc_us, s.success_us);
}

TEST(Gen2Timing, LongerEpcsTakeTheirBits) {
  EXPECT_NEAR(slot_times(kFast, 0, 128.0).epc_us - slot_times(kFast, 0, 96.0).epc_us, 32.0 / 0.64, 1e-9);
}

TEST(Gen2Timing, RefusesWhatNoReaderMaySendAndSaysWhy) {
  const auto why = [](const LinkProfile& link) {
    const auto valid = validate(link);
    return valid ? std::string("accepted") : valid.error().detail;
  };
  EXPECT_EQ(why(kFast), "accepted");
  EXPECT_EQ(why({}), "accepted");
  EXPECT_NE(why({.tari_us = 5.0}).find("tari_us = 5 is not within 6.25 to 25"), std::string::npos);
  EXPECT_NE(why({.tari_us = std::nan("")}).find("tari_us"), std::string::npos);
  EXPECT_NE(why({.pie = 2.1}).find("pie"), std::string::npos);
  EXPECT_NE(why({.blf_khz = 700.0}).find("blf_khz"), std::string::npos);
  EXPECT_NE(why({.m = 3}).find("m = 3"), std::string::npos);
  const std::string trcal = why({.tari_us = 25.0, .pie = 2.0, .blf_khz = 640.0});
  EXPECT_NE(trcal.find("33.3 us (ratio 64/3)"), std::string::npos) << trcal;
  EXPECT_NE(trcal.find("82.5 to 225.0 us"), std::string::npos) << trcal;
}

}  // namespace
}  // namespace forager::mocks
