#include "reader/read_tally.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace forager::reader {
namespace {

using namespace std::chrono_literals;

TagRead read(const char* epc, int port, int rssi_dbm, hal::Duration heard) {
  TagRead out;
  out.epc = Epc::from_hex(epc).value();
  out.port = static_cast<std::uint8_t>(port);
  out.rssi_dbm = static_cast<std::int16_t>(rssi_dbm);
  out.heard = hal::Instant(heard);
  return out;
}

std::vector<ReadPort> two_ports() { return {{4, "front", 0.0, {}, {}}, {2, "right", 0.0, {}, {}}}; }

TEST(ReadTally, CountsReadsAndDifferentTagsInTotalAndByPort) {
  ReadTally tally(two_ports());
  tally.add(std::vector{read("aa01", 4, -50, 1s), read("aa01", 4, -54, 2s), read("aa01", 2, -70, 3s),
                        read("aa02", 2, -60, 4s)});
  EXPECT_EQ(tally.total().reads, 4U);
  EXPECT_EQ(tally.total().tags, 2U);
  ASSERT_EQ(tally.ports().size(), 2U);
  EXPECT_EQ(tally.ports()[0].total.reads, 2U);
  EXPECT_EQ(tally.ports()[0].total.tags, 1U);
  EXPECT_EQ(tally.ports()[1].total.tags, 2U);
  EXPECT_EQ(tally.ports()[0].total.mean_rssi_dbm(), -52.0);
  EXPECT_EQ(tally.ports()[1].total.strongest_dbm, -60);
  EXPECT_EQ(tally.ports()[0].last_heard, hal::Instant(2s));
  EXPECT_EQ(tally.last_heard(), hal::Instant(4s));
}

TEST(ReadTally, AnIntervalForgetsNothingButItself) {
  ReadTally tally(two_ports());
  tally.add(std::vector{read("aa01", 4, -50, 1s)});
  EXPECT_EQ(tally.new_tags(), 1U);
  tally.next_interval();
  EXPECT_EQ(tally.interval().reads, 0U);
  tally.add(std::vector{read("aa01", 4, -50, 2s), read("aa01", 2, -50, 2s), read("aa02", 2, -50, 2s)});
  EXPECT_EQ(tally.interval().reads, 3U);
  EXPECT_EQ(tally.interval().tags, 2U);
  EXPECT_EQ(tally.new_tags(), 1U);
  EXPECT_EQ(tally.total().tags, 2U);
  EXPECT_EQ(tally.ports()[1].interval.tags, 2U);
}

TEST(ReadTally, APortThatIsNotPlannedIsShownAsSuch) {
  ReadTally tally(two_ports());
  tally.add(std::vector{read("aa01", 7, -50, 1s)});
  ASSERT_EQ(tally.ports().size(), 3U);
  EXPECT_EQ(tally.ports()[2].port, 7);
  EXPECT_EQ(tally.ports()[2].name, "not in the plan");
  EXPECT_FALSE(tally.ports()[0].last_heard);
}

TEST(ReadTally, AReadWithoutRssiCountsAndLeavesTheMeanAlone) {
  ReadTally tally(two_ports());
  tally.add(std::vector{read("aa01", 4, TagRead::kNoRssi, 1s), read("aa01", 4, -40, 1s)});
  EXPECT_EQ(tally.total().reads, 2U);
  EXPECT_EQ(tally.total().mean_rssi_dbm(), -40.0);
  EXPECT_FALSE(ReadCount{}.mean_rssi_dbm());
}

TEST(ReadTallyWithoutAPlan, TakesPortsAsTheyCome) {
  ReadTally tally({});
  TagRead read;
  read.port = 3;
  tally.add(std::span(&read, 1));
  ASSERT_EQ(tally.ports().size(), 1U);
  EXPECT_EQ(tally.ports()[0].name, "port 3");
}

}  // namespace
}  // namespace forager::reader
