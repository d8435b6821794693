#include "reader/advannet_events.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include "tests/reader/advannet_sample.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::reader {
namespace {

using test::advannet_file;
using test::advannet_inventory;
using test::advannet_item;
using Kind = AdvanNetMessage::Kind;

AdvanNetMessage decoded(std::string_view body) {
  AdvanNetMessage message;
  const auto result = decode_advannet_message(body, message);
  EXPECT_TRUE(result) << describe(result.error());
  return message;
}

constexpr std::string_view kPlainProps =
    "<prop>RSSI:-60</prop><prop>ANTENNA_PORT:2</prop><prop>FREQ:866300</prop><prop>READ_COUNT:4</prop>";

TEST(AdvanNetEvents, CapturedInventoryOfARealReader) {
  const auto message = decoded(advannet_file("inventory.xml"));
  EXPECT_EQ(message.kind, Kind::inventory);
  EXPECT_EQ(message.bad_items, 0U);
  ASSERT_EQ(message.reads.size(), 1U);
  const TagRead& read = message.reads[0];
  EXPECT_EQ(read.epc.hex(), "bd01fac6");
  EXPECT_EQ(read.reader_ms, 1779868346683);
  EXPECT_EQ(read.rssi_dbm, -22);
  EXPECT_EQ(read.phase_deg, 5.0);
  EXPECT_EQ(read.port, 4);
  EXPECT_EQ(read.frequency_khz, 867500U);
  EXPECT_EQ(read.read_count, 1U);
}

TEST(AdvanNetEvents, FoldedAntennasAreOneReadEach) {
  const auto message = decoded(advannet_file("inventory_folded.xml"));
  ASSERT_EQ(message.reads.size(), 2U);
  const TagRead& first = message.reads[0];
  const TagRead& second = message.reads[1];
  EXPECT_EQ(first.epc, second.epc);
  EXPECT_EQ(first.epc.hex(), "3034257bf7194e4000001a85");
  EXPECT_EQ(first.port, 1);
  EXPECT_EQ(first.rssi_dbm, -61);
  EXPECT_EQ(first.read_count, 3U);
  EXPECT_EQ(first.reader_ms, 1779868346900);
  EXPECT_EQ(first.frequency_khz, 865700U);
  EXPECT_FALSE(first.phase_deg.has_value());
  EXPECT_EQ(second.port, 3);
  EXPECT_EQ(second.rssi_dbm, -70);
  EXPECT_EQ(second.read_count, 2U);
  EXPECT_EQ(second.reader_ms, 1779868346950);
  EXPECT_EQ(second.frequency_khz, 865700U);
}

TEST(AdvanNetEvents, ListsOfUnequalLengthFallBackToTheirFirstValue) {
  const auto message = decoded(advannet_inventory(advannet_item(
      "bd01fac6", 1779868346683,
      "<prop>RSSI:-60,-61,-62</prop><prop>ANTENNA_PORT:1,2</prop><prop>RF_PHASE:10,20</prop>")));
  ASSERT_EQ(message.reads.size(), 2U);
  EXPECT_EQ(message.reads[0].rssi_dbm, -60);
  EXPECT_EQ(message.reads[1].rssi_dbm, -60);
  EXPECT_EQ(message.reads[1].phase_deg, 20.0);
  const auto one_port = decoded(advannet_inventory(
      advannet_item("bd01fac6", 1779868346683, "<prop>RSSI:-60,-61</prop><prop>ANTENNA_PORT:3</prop>")));
  ASSERT_EQ(one_port.reads.size(), 1U);
  EXPECT_EQ(one_port.reads[0].rssi_dbm, -60);
  EXPECT_EQ(one_port.reads[0].port, 3);
}

TEST(AdvanNetEvents, InputLevelsDoNotShadowAProperty) {
  const auto message = decoded(advannet_inventory(advannet_item(
      "bd01fac6", 1779868346683, "<prop>GPI:{RSSI:-1:ANTENNA_PORT:9}</prop>" + std::string(kPlainProps))));
  ASSERT_EQ(message.reads.size(), 1U);
  EXPECT_EQ(message.reads[0].port, 2);
  EXPECT_EQ(message.reads[0].rssi_dbm, -60);
}

TEST(AdvanNetEvents, EmptyInventoryIsNoError) {
  for (const char* items : {"", "  \n"}) {
    const auto message = decoded(advannet_inventory(items));
    EXPECT_EQ(message.kind, Kind::inventory);
    EXPECT_TRUE(message.reads.empty());
  }
  EXPECT_EQ(decoded("<inventory/>").kind, Kind::inventory);
}

TEST(AdvanNetEvents, OneBadItemDoesNotCostTheOthers) {
  const auto message = decoded(advannet_inventory(advannet_item("bd01fac6", 1779868346683, kPlainProps) +
                                                  advannet_item("xyz", 1779868346683, kPlainProps) +
                                                  advannet_item("", 1779868346683, kPlainProps) +
                                                  advannet_item("bd01fac7", 1779868346684, kPlainProps)));
  EXPECT_EQ(message.reads.size(), 2U);
  EXPECT_EQ(message.bad_items, 2U);
}

TEST(AdvanNetEvents, MissingOrOddNumbersReadAsNotReported) {
  for (const char* props :
       {"", "<prop>RSSI</prop>", "<prop>RSSI:</prop><prop>ANTENNA_PORT:</prop>",
        "<prop>RSSI:nan</prop><prop>ANTENNA_PORT:300</prop><prop>FREQ:-1</prop><prop>READ_COUNT:x</prop>",
        "<prop>RSSI:99999</prop><prop>RF_PHASE:inf</prop><prop>READ_COUNT:0</prop>"}) {
    const auto message = decoded(advannet_inventory(advannet_item("bd01fac6", 1779868346683, props)));
    ASSERT_EQ(message.reads.size(), 1U) << props;
    EXPECT_EQ(message.reads[0].rssi_dbm, TagRead::kNoRssi) << props;
    EXPECT_EQ(message.reads[0].port, 0) << props;
    EXPECT_EQ(message.reads[0].frequency_khz, 0U) << props;
    EXPECT_EQ(message.reads[0].read_count, 1U) << props;
    EXPECT_FALSE(message.reads[0].phase_deg) << props;
  }
}

TEST(AdvanNetEvents, ItemWithoutTimeTakesTheNextBestOne) {
  const auto of = [](std::string_view item) {
    return decoded(advannet_inventory(item)).reads.at(0).reader_ms;
  };
  EXPECT_EQ(
      of("<item><epc>bd01fac6</epc><data><props><prop>TIME_STAMP:1779868340001</prop></props></data></item>"),
      1779868340001);
  EXPECT_EQ(of("<item><epc>bd01fac6</epc></item>"), 1779868346683);
  const auto hopeless = decoded("<inventory><items><item><epc>bd01fac6</epc></item></items></inventory>");
  EXPECT_EQ(hopeless.bad_items, 1U);
}

TEST(AdvanNetEvents, InputEventHasLineAndLevel) {
  const auto message = decoded(advannet_file("gpi_event.xml"));
  EXPECT_EQ(message.kind, Kind::device_event);
  ASSERT_EQ(message.inputs.size(), 1U);
  EXPECT_EQ(message.inputs[0].line, 1);
  EXPECT_TRUE(message.inputs[0].high);
  EXPECT_EQ(message.inputs[0].reader_ms, 1779868346683);
  const auto broken =
      decoded("<deviceEventMessage><event><type>GPI</type><line>1</line></event></deviceEventMessage>");
  EXPECT_TRUE(broken.inputs.empty());
  EXPECT_EQ(broken.bad_items, 1U);
}

TEST(AdvanNetEvents, ServerEventHasTypeAndReadableText) {
  const auto message = decoded(advannet_file("server_event.xml"));
  EXPECT_EQ(message.kind, Kind::server_event);
  EXPECT_EQ(message.type, "ADVANNET_DEVICE_STARTED");
  EXPECT_EQ(message.text, "Device <AdvanReader-m4-160> started & running");
}

TEST(AdvanNetEvents, UnknownRootIsNoError) {
  EXPECT_EQ(decoded("<sensorMessage><item><epc>bd01fac6</epc><ts>1</ts></item></sensorMessage>").kind,
            Kind::unknown);
}

TEST(AdvanNetEvents, MalformedDocumentGivesNothingAtAll) {
  const std::string sound = advannet_file("inventory.xml");
  AdvanNetMessage message;
  const std::size_t end = sound.find_last_of('>');
  for (std::size_t size = 0; size < end; ++size) {
    const auto result = decode_advannet_message(std::string_view(sound).substr(0, size), message);
    ASSERT_FALSE(result) << size;
    ASSERT_EQ(result.error().code, hal::ErrorCode::protocol);
    ASSERT_TRUE(message.reads.empty());
  }
}

TEST(AdvanNetEvents, JsonSaysWhichSettingIsWrong) {
  AdvanNetMessage message;
  const auto result = decode_advannet_message(R"({"type":"inv","ver":"v3"})", message);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, hal::ErrorCode::unsupported);
  EXPECT_NE(describe(result.error()).find("COMM_TCP3177_ENCODER"), std::string::npos);
}

TEST(AdvanNetEvents, DecodingAllocatesNothingAfterTheFirstMessage) {
  std::string items;
  for (int i = 0; i < 20; ++i)
    items += advannet_item("3034257bf7194e4000001a85", 1779868346683 + i, kPlainProps);
  const std::string large = advannet_inventory(items);
  const std::string small = advannet_file("inventory.xml");
  AdvanNetMessage message;
  ASSERT_TRUE(decode_advannet_message(large, message));
  const std::uint64_t before = test::allocation_count();
  std::size_t reads = 0;
  for (int i = 0; i < 1000; ++i) {
    for (const std::string* body : {&large, &small}) {
      if (!decode_advannet_message(*body, message)) break;
      reads += message.reads.size();
    }
  }
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(reads, 21'000U);
}

RC_GTEST_PROP(AdvanNetEventsProperty, OrderOfPropertiesDoesNotMatter, ()) {
  std::vector<std::string> props{"<prop>TIME_STAMP:1779868346683</prop>",
                                 "<prop>RSSI:-71</prop>",
                                 "<prop>RF_PHASE:95</prop>",
                                 "<prop>ANTENNA_PORT:3</prop>",
                                 "<prop>MUX1:0</prop>",
                                 "<prop>FREQ:865700</prop>",
                                 "<prop>GPI:{0:0:0:1}</prop>",
                                 "<prop>READ_COUNT:2</prop>"};
  for (std::size_t i = props.size() - 1; i > 0; --i)
    std::swap(props[i], props[*rc::gen::inRange<std::size_t>(0, i + 1)]);
  std::string joined;
  for (const auto& prop : props) joined += prop;
  AdvanNetMessage message;
  RC_ASSERT(
      decode_advannet_message(advannet_inventory(advannet_item("bd01fac6", 1779868346683, joined)), message)
          .has_value());
  RC_ASSERT(message.reads.size() == 1);
  RC_ASSERT(message.reads[0].rssi_dbm == -71 && message.reads[0].port == 3 &&
            message.reads[0].read_count == 2);
  RC_ASSERT(message.reads[0].frequency_khz == 865700 && message.reads[0].phase_deg == 95.0);
}

}  // namespace
}  // namespace forager::reader
