// The event stream of the emulated reader, byte for byte, and what the air is told.
#include <gmock/gmock.h>

#include "tests/mocks/sim_reader_bench.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view kKeepAlive =
    "ADVANNET/1.1\r\nContent-Length:0\r\nContent-Type:text/xml\r\n\r\n\r\n\r\n";

struct SimReaderStream : testing::Test {
  explicit SimReaderStream(const SimReaderConfig& config = {}) : bench(config) {
    bench.reader.streams().attach(bench.line);
    bench.dial();
    bench.run_until(0.005);
  }
  SimReaderBench bench;
};

TEST_F(SimReaderStream, AReadBecomesTheFrameOfARealReader) {
  const auto tag = bench.field.add_tag("bd01fac6");
  bench.device_get("start");
  bench.field.add_reply({tag, 1, -22, 5, 867500, SimReaderBench::at(0.1)});
  bench.run_until(0.2);
  // The reader came up at 0.005 s; the frame leaves 10 ms after the read.
  const std::string body =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<inventory><type>inventory</type><ts>1779868340105</ts><status>OK</status>"
      "<msg-version>2.3.0</msg-version><op>inventory</op>"
      "<data><advanNetId>AdvanNet-instance-64:cf:d9:c7:56:1c--1</advanNetId>"
      "<deviceId>AdvanReader-m4-160</deviceId>"
      "<inventory><class>INVENTORY</class><deviceId>AdvanReader-m4-160</deviceId><size>1</size>"
      "<items><item>"
      "<class>READ_EVENT</class><epc>bd01fac6</epc><decoded></decoded><ts>1779868340095</ts>"
      "<deviceId>AdvanReader-m4-160</deviceId>"
      "<data><class>TAG_DATA</class><hexepc>bd01fac6</hexepc><tid></tid><data></data>"
      "<props>"
      "<prop>TIME_STAMP:1779868340095</prop><prop>RSSI:-22</prop><prop>RF_PHASE:5</prop>"
      "<prop>ANTENNA_PORT:1</prop><prop>MUX1:0</prop><prop>MUX2:0</prop><prop>FREQ:867500</prop>"
      "<prop>GPI:{0:0:0:0}</prop><prop>READ_COUNT:1</prop>"
      "</props></data>"
      "<location><class>LOCATION_DEFINITION</class><loc></loc><ts></ts></location>"
      "</item></items></inventory></data></inventory>";
  EXPECT_EQ(bench.heard,
            fmt::format("ADVANNET/1.1\r\nContent-Length:{}\r\nContent-Type:text/xml\r\n\r\n{}\r\n\r\n",
                        body.size(), body));
}

TEST_F(SimReaderStream, KeepAlivesComeEveryFiveSecondsAndNothingElseDoes) {
  bench.run_until(5.0);
  EXPECT_EQ(bench.heard, "");
  bench.run_until(5.01);
  EXPECT_EQ(bench.heard, kKeepAlive);
  bench.run_until(31.0);
  EXPECT_EQ(bench.heard.size(), 6 * kKeepAlive.size());
}

TEST_F(SimReaderStream, WhatAClientSendsIsIgnored) {
  const std::string ack = "ADVANNET/1.0 200 OK\r\n\r\n";
  for (int k = 0; k < 100; ++k)
    ASSERT_TRUE(bench.line.near().write(std::as_bytes(std::span(ack))).has_value());
  bench.run_until(6.0);
  EXPECT_EQ(bench.heard, kKeepAlive);
}

TEST_F(SimReaderStream, TheAirIsToldWhatWasConfiguredOverTheWire) {
  bench.device_put("reader/parameter/GEN2_SESSION", "S1");
  bench.device_put("reader/parameter/GEN2_TARGET", "AB");
  bench.device_put("reader/parameter/GEN2_Q", "Q_6");
  bench.device_put("reader/parameter/RF_READ_POWER", "27.5");
  bench.device_put("reader/parameter/RF_SENSITIVITY", "-75");
  bench.device_put("readModes[0]", "<request><onTime>250</onTime><offTime>50</offTime></request>");
  bench.device_put(
      "antennas",
      "<request><entries><entry><def>AdvanReader-m4-160,4,0,0,-1,front,0,0,0</def></entry>"
      "<entry><def>AdvanReader-m4-160,2,0,0,-1,right,0,0,0</def>"
      "<conf><power>20</power><sensitivity>-60</sensitivity></conf></entry></entries></request>");
  EXPECT_FALSE(bench.field.on());
  bench.device_get("start");
  ASSERT_TRUE(bench.field.on());
  const RadioSettings& radio = bench.field.settings();
  EXPECT_EQ(radio.session, 1);
  EXPECT_EQ(radio.target, '*');
  EXPECT_EQ(radio.q, 6);
  EXPECT_EQ(radio.on_time, 250ms);
  EXPECT_EQ(radio.off_time, 50ms);
  ASSERT_EQ(radio.ports.size(), 2U);
  EXPECT_EQ(radio.ports[0].port, 4);
  EXPECT_EQ(radio.ports[0].power_dbm, 27.5);
  EXPECT_EQ(radio.ports[0].sensitivity_dbm, -75.0);
  EXPECT_EQ(radio.ports[1].port, 2);
  EXPECT_EQ(radio.ports[1].power_dbm, 20.0);
  EXPECT_EQ(radio.ports[1].sensitivity_dbm, -60.0);

  bench.device_get("start");
  EXPECT_EQ(bench.field.times_on(), 1) << "starting a running reader is harmless";
  bench.device_put("reader/parameter/RF_READ_POWER", "15");
  EXPECT_EQ(bench.field.settings().ports[0].power_dbm, 15.0);
  bench.device_get("stop");
  EXPECT_FALSE(bench.field.on());
}

TEST_F(SimReaderStream, BatchesGrowLongerWithTheRate) {
  const auto tag = bench.field.add_tag("aa");
  bench.device_get("start");
  for (int k = 0; k < 20; ++k) bench.reply(tag, 0.1 + 0.05 * k);     // 20 a second
  for (int k = 0; k < 1000; ++k) bench.reply(tag, 2.0 + 0.002 * k);  // 500 a second
  bench.run_until(1.5);
  EXPECT_EQ(occurrences(bench.heard, "<size>1</size>"), 20);
  bench.run_until(3.0);
  bench.heard.clear();
  bench.run_until(4.0);
  const int frames = occurrences(bench.heard, "ADVANNET/1.1\r\nContent-Length:") -
                     occurrences(bench.heard, "Content-Length:0\r\n");
  EXPECT_GE(frames, 6);  // one second in batches of 150 ms
  EXPECT_LE(frames, 7);
}

TEST_F(SimReaderStream, InventoryAnswersFromTheLastTimeWindowOnePerTagAndPort) {
  const auto tag = bench.field.add_tag("e200");
  bench.device_get("start");
  bench.reply(tag, 0.5, 1, -70);
  bench.reply(tag, 2.0, 1, -65);
  bench.reply(tag, 2.2, 1, -61);
  bench.run_until(4.0);
  const std::string body = bench.device_get("inventory").body;
  EXPECT_THAT(body, StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<inventory>"));
  EXPECT_THAT(body, HasSubstr("<size>1</size>"));
  EXPECT_THAT(body, HasSubstr("RSSI:-61<"));
  EXPECT_THAT(body, HasSubstr("READ_COUNT:2<"));
  EXPECT_THAT(bench.device_get("location").body,
              HasSubstr("<locationData><epc>e200</epc><location><loc>shelf1,0,0,0</loc></location>"));
  EXPECT_THAT(bench.device_get("jsonMinLocation").body,
              HasSubstr(R"(<data><result>[{"epc":"e200","ts":1779868342195,"port":1,"mux1":0,"mux2":0,)"
                        R"("rssi":-61,"phase":45,"rc":2}]</result></data>)"));
  bench.run_until(5.0);
  EXPECT_THAT(bench.device_get("inventory").body, HasSubstr("<size>0</size>"));
}

TEST_F(SimReaderStream, SequentialReadsOnlyWhenAskedAndAnswersAfterTheSweep) {
  const auto tag = bench.field.add_tag("e200");
  bench.device_put("activeDeviceMode", "Sequential");
  bench.device_get("start");
  bench.reply(tag, 1.0);
  bench.reply(tag, 2.1);
  bench.run_until(2.0);
  EXPECT_FALSE(bench.field.on());
  const auto request =
      bench.reader.submit(hal::HttpMethod::get, "/devices/AdvanReader-m4-160/inventory", "", bench.now);
  EXPECT_FALSE(bench.reader.take(request, bench.now).has_value());
  EXPECT_TRUE(bench.field.on());
  bench.run_until(2.49);
  EXPECT_FALSE(bench.reader.take(request, bench.now).has_value());
  bench.run_until(2.5);
  const auto reply = bench.reader.take(request, bench.now);
  ASSERT_TRUE(reply.has_value());
  EXPECT_THAT(reply->body, HasSubstr("<size>1</size>"));
  EXPECT_THAT(reply->body, HasSubstr("<ts>1779868342095</ts>"));
  EXPECT_FALSE(bench.field.on());
  EXPECT_EQ(bench.heard, "");
}

TEST_F(SimReaderStream, InputChangesArePushed) {
  bench.reader.set_gpi(1, true, bench.now);
  bench.reader.set_gpi(1, true, bench.now);
  bench.run_until(0.1);
  EXPECT_THAT(bench.heard,
              HasSubstr("<deviceEventMessage><deviceId>AdvanReader-m4-160</deviceId>"
                        "<event><class>GPI_EVENT</class><type>GPI</type><ts>1779868340000</ts>"
                        "<deviceId>AdvanReader-m4-160</deviceId>"
                        "<line>1</line><lowToHigh>true</lowToHigh></event></deviceEventMessage>"));
  EXPECT_EQ(occurrences(bench.heard, "ADVANNET"), 1);
  const auto tag = bench.field.add_tag("aa");
  bench.device_get("start");
  bench.reply(tag, 0.2);
  bench.run_until(0.3);
  EXPECT_THAT(bench.heard, HasSubstr("GPI:{1:0:0:0}"));
}

TEST_F(SimReaderStream, ASlowClientLosesTheOldestFramesAndNeverHalfOfOne) {
  const auto tag = bench.field.add_tag("aa");
  bench.device_get("start");
  bench.line.limit_in_flight(100);  // nobody reads: the first frame stays half on the wire
  for (int k = 0; k < 150; ++k) bench.reply(tag, 0.1 + 0.1 * k, 1, -20 - k % 60);
  while (bench.now < SimReaderBench::at(16.0)) bench.reader.update(bench.now += 5ms);
  EXPECT_GT(bench.reader.streams().clients(), 0U);
  bench.line.limit_in_flight(SIZE_MAX);
  bench.run_until(16.5);
  EXPECT_EQ(occurrences(bench.heard, "ADVANNET/1.1\r\n"), 100);
  EXPECT_EQ(bench.reader.streams().frames_dropped(), 150 + 3 - 100U);
  EXPECT_THAT(bench.heard, HasSubstr("<ts>1779868340095</ts>")) << "the half-sent frame is finished";
  EXPECT_THAT(bench.heard, Not(HasSubstr("<ts>1779868340195</ts>"))) << "the next oldest is gone";
  EXPECT_THAT(bench.heard, HasSubstr("<ts>1779868354995</ts>"));
}

TEST_F(SimReaderStream, AFifthClientIsClosed) {
  std::vector<std::unique_ptr<MemoryStreamPair>> lines;
  for (int k = 0; k < 4; ++k) {
    lines.push_back(std::make_unique<MemoryStreamPair>("line", MemoryStreamKind::bytes));
    bench.reader.streams().attach(*lines.back());
    ASSERT_TRUE(lines.back()->near().open().has_value());
    ASSERT_TRUE(lines.back()->near().poll().has_value());
    bench.run_until(0.1 * (k + 1));
  }
  EXPECT_EQ(bench.reader.streams().clients(), 4U);
  std::byte byte{};
  EXPECT_TRUE(lines[2]->near().read({&byte, 1}).has_value());
  const auto turned_away = lines[3]->near().read({&byte, 1});
  ASSERT_FALSE(turned_away.has_value());
  EXPECT_EQ(turned_away.error().code, hal::ErrorCode::disconnected);

  lines[0]->near().close();
  bench.run_until(1.0);
  ASSERT_TRUE(lines[3]->near().open().has_value());
  ASSERT_TRUE(lines[3]->near().poll().has_value());
  bench.run_until(1.1);
  EXPECT_TRUE(lines[3]->near().read({&byte, 1}).has_value()) << "a place is free again";
  for (const auto& line : lines) bench.reader.streams().detach(line->far());
}

TEST_F(SimReaderStream, APowerCutIsSilentAndARebootIsNot) {
  bench.reader.power_cut(bench.now);
  bench.run_until(20.0);
  EXPECT_EQ(bench.heard, "");
  EXPECT_EQ(bench.line.near().state(), hal::StreamState::open) << "nobody tells the client";
  bench.reader.power_on(bench.now);
  bench.run_until(20.1);
  EXPECT_EQ(bench.line.near().state(), hal::StreamState::closed);
  EXPECT_FALSE(bench.dial()) << "refused while booting";
  bench.run_until(46.0);
  EXPECT_TRUE(bench.dial());
  bench.run_until(52.0);
  EXPECT_EQ(bench.heard, kKeepAlive);
}

TEST_F(SimReaderStream, EqualSeedsGiveEqualBytes) {
  const auto run = [] {
    SimReaderConfig config;
    config.seed = 7;
    config.faults = {.split_frame = 0.2, .garbage_lines = 0.2, .out_of_order = 0.3, .duplicate = 0.3};
    config.journal_wire = true;
    SimReaderBench other(config);
    other.reader.streams().attach(other.line);
    other.dial();
    const auto tag = other.field.add_tag("aa");
    other.run_until(0.1);
    other.device_get("start");
    for (int k = 0; k < 300; ++k) other.reply(tag, 0.2 + 0.01 * k);
    other.run_until(6.0);
    return std::pair(other.heard, other.journal.hash());
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace forager::mocks
