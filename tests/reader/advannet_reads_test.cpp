// Which reads and events the driver hands out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reader/advannet_reader.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using test::AdvanNetRig;
using ::testing::HasSubstr;

TEST(AdvanNetReader, ReadsFromBeforeTheStartAreDroppedAndCounted) {
  AdvanNetRig rig;
  rig.open();
  rig.read("aaaa0001", 5s);  // the link has been open for less than a second
  rig.read("aaaa0002");
  rig.read("aaaa0003", 60s);
  rig.run(100ms);
  ASSERT_EQ(rig.reads.size(), 1U);
  EXPECT_EQ(rig.reads[0].epc.hex(), "aaaa0002");
  EXPECT_EQ(rig.driver.counters().stale, 2U);
}

TEST(AdvanNetReader, ReadsThatArriveWithTheStartAnswerAreNotMissed) {
  AdvanNetRig rig;
  rig.fake.latency = 200ms;
  rig.driver.start(rig.now);
  while (rig.fake.count("GET start") == 0) rig.run(10ms);
  rig.run(100ms);
  rig.read("aaaa0001", 0s);      // before the start was answered: its stamp lies before the answer's
  rig.read("aaaa0002", -150ms);  // stamped after it
  rig.run(1s);
  EXPECT_EQ(rig.driver.counters().stale, 1U);
  ASSERT_EQ(rig.reads.size(), 1U);
  EXPECT_EQ(rig.reads[0].epc.hex(), "aaaa0002");
}

TEST(AdvanNetReader, ReadsOutOfOrderAreKeptInOrderOfArrivalAndCounted) {
  AdvanNetRig rig;
  rig.open();
  rig.run(5s);
  rig.read("aaaa0001");
  rig.read("aaaa0002", 1670ms);
  rig.read("aaaa0003", 10ms);
  rig.read("aaaa0004");
  rig.run(100ms);
  ASSERT_EQ(rig.reads.size(), 4U);
  EXPECT_EQ(rig.driver.counters().out_of_order, 2U);
  EXPECT_LT(rig.reads[1].heard, rig.reads[0].heard);
  EXPECT_EQ(rig.reads[1].arrived, rig.reads[0].arrived);
}

TEST(AdvanNetReader, MalformedMessageCostsItselfOnly) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.send(test::advannet_frame("<inventory><items><item>"));
  rig.fake.send("some line\r\n");
  rig.fake.send(test::advannet_frame("<future><x/></future>"));
  rig.read("aaaa0001");
  rig.run(100ms);
  EXPECT_EQ(rig.reads.size(), 1U);
  EXPECT_EQ(rig.driver.counters().malformed, 1U);
  EXPECT_EQ(rig.driver.counters().unknown, 1U);
  EXPECT_EQ(rig.driver.stream_counters().garbage_lines, 1U);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.journal.count("ends inside an element"), 1U);
}

TEST(AdvanNetReader, ReaderSetToJsonFailsInsteadOfShowingNoTags) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.send(test::advannet_frame(R"({"type":"inv","ver":"v3","data":{"epc":"bd01fac6"}})"));
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("COMM_TCP3177_ENCODER"));
  EXPECT_EQ(rig.fake.status, "STOPPED") << "a failed link leaves the radio off";
  EXPECT_TRUE(rig.driver.idle());
}

TEST(AdvanNetReader, EventsOfTheReaderReachTheJournal) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.send(
      test::advannet_frame("<eventMessage><event><type>ADVANNET_READER_ERROR</type><msg>High return "
                           "loss</msg></event></eventMessage>"));
  rig.run(100ms);
  EXPECT_EQ(rig.journal.count("event ADVANNET_READER_ERROR: High return loss"), 1U);
}

}  // namespace
}  // namespace forager::reader
