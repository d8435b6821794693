// The driver from the first request to the last: what it sends, and what it makes of each answer.
#include "reader/advannet_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/scripted_http_client.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using test::AdvanNetRig;
using test::rig_config;
using test::rig_plan;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr auto kGet = hal::HttpMethod::get;
constexpr auto kPut = hal::HttpMethod::put;

std::string ok(long long ts, std::string_view data = {}) {
  return "<response><type>response</type><ts>" + std::to_string(ts) +
         "</ts><status>OK</status><msg-version>2.3.0</msg-version><op>x</op>" +
         (data.empty() ? std::string() : "<data>" + std::string(data) + "</data>") + "</response>";
}

// The published dialogue, request by request.
TEST(AdvanNetReader, SpeaksThePublishedDialogue) {
  const std::string base = "/devices/AdvanReader-m4-160/";
  const std::string parameter = base + "reader/parameter/";
  mocks::ScriptedHttpClient rest("192.168.1.50:3161", [](const std::string& why) { ADD_FAILURE() << why; });
  rest.expect(kGet, "/devices").answer(200, test::advannet_file("devices.xml"));
  rest.expect(kGet, "/status").answer(200, test::advannet_file("status.xml"));
  rest.expect(kGet, base + "stop").answer(200, ok(1779868340100));
  rest.expect(kPut, base + "activeDeviceMode", "Autonomous").answer(200, ok(1779868340200));
  rest.expect(kPut, base + "readModes%5B0%5D").answer(200, ok(1779868340300));
  rest.expect(
          kPut, base + "antennas",
          "<request><entries><entry><class>ANTENNA_DEFINITION</class>"
          "<def>AdvanReader-m4-160,1,0,0,-1,front,0,0,0</def>"
          "<conf><class>ANTENNA_CONF</class><power>30</power><sensitivity>-70</sensitivity><readTime/></conf>"
          "</entry><entry><class>ANTENNA_DEFINITION</class>"
          "<def>AdvanReader-m4-160,2,0,0,-1,left,0,0,0</def>"
          "<conf><class>ANTENNA_CONF</class><power/><sensitivity/><readTime/></conf></entry>"
          "</entries></request>")
      .answer(200, ok(1779868340400));
  rest.expect(kPut, parameter + "RF_READ_POWER", "30").answer(200, ok(1779868340500));
  rest.expect(kPut, parameter + "RF_SENSITIVITY", "-70").answer(200, ok(1779868340600));
  rest.expect(kPut, parameter + "GEN2_SESSION", "S1").answer(200, ok(1779868340700));
  rest.expect(kPut, parameter + "GEN2_TARGET", "A").answer(200, ok(1779868340800));
  rest.expect(kPut, parameter + "GEN2_Q", "Q_DYNAMIC").answer(200, ok(1779868340900));
  rest.expect(kGet, parameter + "RF_READ_POWER").answer(200, ok(1779868341000, "<result>30.0</result>"));
  rest.expect(kGet, parameter + "GEN2_SESSION").answer(200, ok(1779868341100, "<result>S1</result>"));
  rest.expect(kGet, parameter + "GEN2_TARGET").answer(200, ok(1779868341200, "<result>A</result>"));
  rest.expect(kGet, base + "start").answer(200, ok(1779868346500));
  rest.expect(kGet, base + "stop").answer(200, ok(1779868350000));

  mocks::MemoryStreamPair wire("tcp 192.168.1.50:3177", mocks::MemoryStreamKind::bytes);
  mocks::TextJournal journal;
  AdvanNetReader driver(rest, wire.near(), journal, rig_plan(), rig_config());
  hal::Instant now(1s);
  const auto run = [&](int updates) {
    for (int i = 0; i < updates; ++i) driver.update(now += 100ms);
  };
  driver.start(now);
  EXPECT_EQ(driver.link().phase, LinkPhase::opening);
  run(30);
  EXPECT_EQ(driver.link().phase, LinkPhase::open) << driver.link().reason;
  EXPECT_EQ(driver.device().serial, "0091104::64cfd9c7561c");

  const std::string frame = test::advannet_frame(test::advannet_file("inventory.xml"));
  ASSERT_EQ(wire.far().write(std::as_bytes(std::span(frame))), frame.size());
  run(1);
  ASSERT_EQ(driver.reads().size(), 1U);
  EXPECT_EQ(driver.reads()[0].epc.hex(), "bd01fac6");
  EXPECT_EQ(driver.reads()[0].arrived, now);

  driver.stop(now);
  run(2);
  EXPECT_TRUE(driver.idle());
  EXPECT_EQ(driver.link().phase, LinkPhase::closed);
  EXPECT_FALSE(wire.connected());
}

TEST(AdvanNetReader, NothingIsSentBeforeTheStart) {
  AdvanNetRig rig;
  rig.run(5s);
  EXPECT_TRUE(rig.fake.requests.empty());
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::closed);
}

TEST(AdvanNetReader, StreamIsConnectedBeforeTheRadioStarts) {
  AdvanNetRig rig;
  rig.fake.wire.hold_connects(true);
  rig.driver.start(rig.now);
  rig.run(1s);
  EXPECT_EQ(rig.fake.count("GET start"), 0U);
  ASSERT_TRUE(rig.fake.wire.accept());
  rig.run(100ms);
  EXPECT_EQ(rig.fake.count("GET start"), 1U);
}

TEST(AdvanNetReader, SeveralDevicesNeedAName) {
  AdvanNetRig rig;
  rig.fake.ids = {"AdvanReader-m4-160", "AdvanReader-m2-70-76af"};
  rig.driver.start(rig.now);
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(rig.driver.link().reason,
              HasSubstr("there are 2 devices: AdvanReader-m4-160, AdvanReader-m2-70-76af"));
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("Set [reader] device"));

  auto config = rig_config();
  config.device_id = "AdvanReader-m2-70-76af";
  AdvanNetRig named(config);
  named.fake.ids = rig.fake.ids;
  named.open();
  EXPECT_EQ(named.driver.device().id, "AdvanReader-m2-70-76af");

  config.device_id = "simulator";
  AdvanNetRig mistaken(config);
  mistaken.driver.start(mistaken.now);
  mistaken.run(1s);
  EXPECT_EQ(mistaken.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(mistaken.driver.link().reason,
              HasSubstr("no device 'simulator', there is: AdvanReader-m4-160"));
}

TEST(AdvanNetReader, ReaderThatListsNoDeviceYetIsAskedAgain) {
  AdvanNetRig rig;
  rig.fake.ids.clear();
  rig.fake.ids.emplace_back();  // an entry without an id
  rig.driver.start(rig.now);
  rig.run(500ms);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  rig.fake.ids = {"AdvanReader-m4-160"};
  rig.run(3s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
}

TEST(AdvanNetReader, ShutDownDeviceIsConnectedFirst) {
  AdvanNetRig rig;
  rig.fake.status = "SHUTDOWN";
  rig.open();
  EXPECT_THAT(std::vector<std::string>(rig.fake.requests.begin(), rig.fake.requests.begin() + 4),
              ElementsAre("GET /devices", "GET /status", "GET connect", "GET stop"));
}

TEST(AdvanNetReader, WrongPasswordFailsAtOnceAndSaysWhatToDo) {
  AdvanNetRig rig;
  rig.fake.wrong_password = true;
  rig.driver.start(rig.now);
  rig.run(120s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_EQ(
      rig.driver.link().reason,
      "AdvanReader at 192.168.1.50:3161: GET /devices: 401 Unauthorized (tried 1 time). Set the reader's "
      "user and password in the board file");
  EXPECT_EQ(rig.fake.requests.size(), 1U) << "no hammering: accounts get locked";
}

}  // namespace
}  // namespace forager::reader
