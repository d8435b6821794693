// Stopping the reader whatever goes on, and its own inputs and outputs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reader/advannet_reader.hpp"
#include "tests/reader/advannet_rig.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using test::AdvanNetRig;
using test::rig_config;
using ::testing::HasSubstr;

TEST(AdvanNetReader, HaltStopsTheRadioAtOnce) {
  AdvanNetRig rig;
  rig.open();
  auto& relay = rig.driver.gpo(9);
  ASSERT_TRUE(relay.set(true));
  rig.run(100ms);
  ASSERT_TRUE(rig.fake.outputs.at(9));
  rig.driver.halt();
  rig.driver.halt();
  EXPECT_EQ(rig.fake.requests.back(), "GET stop") << "sent before halt() returned";
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::closed);
  rig.run(200ms);
  EXPECT_EQ(rig.fake.status, "STOPPED");
  EXPECT_FALSE(rig.fake.outputs.at(9));
  EXPECT_TRUE(rig.driver.idle());
  EXPECT_EQ(rig.fake.count("GET stop"), 2U) << "one when configuring, one now";
  EXPECT_FALSE(rig.driver.may_radiate());
}

TEST(AdvanNetReader, HaltInTheMiddleOfARequestStillSendsTheStop) {
  AdvanNetRig rig;
  rig.fake.latency = 300ms;
  rig.driver.start(rig.now);
  while (rig.fake.count("GET start") == 0) rig.run(10ms);
  rig.driver.halt();
  EXPECT_EQ(rig.fake.requests.back(), "GET stop");
  rig.run(1s);
  EXPECT_TRUE(rig.driver.idle());
}

TEST(AdvanNetReader, HaltOfADeadReaderEndsInBoundedTime) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.silent = true;
  rig.driver.halt();
  rig.run(5s);
  EXPECT_TRUE(rig.driver.idle());
  EXPECT_TRUE(rig.driver.may_radiate()) << "nobody has heard that it stopped";
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::closed);
}

TEST(AdvanNetReader, StartRightAfterAStopOpensAgain) {
  AdvanNetRig rig;
  rig.open();
  rig.driver.stop(rig.now);
  rig.driver.start(rig.now);
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.fake.status, "RUNNING");
  rig.read("aaaa0001");
  rig.run(20ms);
  EXPECT_EQ(rig.reads.size(), 1U);
}

TEST(AdvanNetReader, OutputsFollowTheLastWishAndReportRefusalsAtTheNextSet) {
  AdvanNetRig rig;
  auto& lamp = rig.driver.gpo(1);
  EXPECT_EQ(&lamp, &rig.driver.gpo(1));
  rig.open();
  EXPECT_FALSE(rig.fake.outputs.at(1)) << "inactive at the first contact";
  ASSERT_TRUE(lamp.set(true));
  ASSERT_TRUE(lamp.set(false));
  ASSERT_TRUE(lamp.set(true));
  rig.run(200ms);
  EXPECT_TRUE(rig.fake.outputs.at(1));
  EXPECT_EQ(rig.fake.count("GET setGPO/1/true"), 1U);

  rig.fake.errors["true"] = "INVALID_GPO_NUMBER: 44";
  auto& beyond = rig.driver.gpo(44);
  ASSERT_TRUE(beyond.set(true));
  rig.run(200ms);
  const auto refused = beyond.set(true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, hal::ErrorCode::invalid_argument);
  EXPECT_THAT(describe(refused.error()), HasSubstr("GET setGPO/44/true: answered INVALID_GPO_NUMBER"));
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
}

TEST(AdvanNetReader, InputsShowTheirLevelsAndChanges) {
  auto config = rig_config();
  config.read_inputs = true;
  AdvanNetRig rig(config);
  rig.open();
  ASSERT_EQ(rig.inputs.size(), 2U);
  EXPECT_TRUE(rig.inputs[0].high);
  rig.fake.send(test::advannet_frame(test::advannet_file("gpi_event.xml")));
  rig.run(100ms);
  ASSERT_EQ(rig.inputs.size(), 3U);
  EXPECT_EQ(rig.inputs[2].line, 1);
  rig.run(100ms);
  EXPECT_TRUE(rig.driver.inputs().empty()) << "each change once";
}

TEST(AdvanNetReader, SteadyStateAllocatesNothing) {
  auto config = rig_config();
  config.status_period = 1h;  // its REST exchanges do allocate
  AdvanNetRig rig(config);
  rig.open();
  std::string items;
  for (int i = 0; i < 20; ++i)
    items += test::advannet_item("3034257bf7194e4000001a85", rig.fake.ms(rig.now) + i,
                                 "<prop>RSSI:-60</prop><prop>ANTENNA_PORT:1</prop>");
  const std::string frame = test::advannet_frame(test::advannet_inventory(items));
  const auto step = [&] {
    rig.now += 10ms;
    rig.fake.send(frame);
    rig.driver.update(rig.now);
    return rig.driver.reads().size();
  };
  step();
  const std::uint64_t before = test::allocation_count();
  std::size_t reads = 0;
  for (int i = 0; i < 1000; ++i) reads += step();
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(reads, 20'000U);
}

}  // namespace
}  // namespace forager::reader
