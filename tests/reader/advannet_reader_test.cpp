// The driver from the first request to the last: what it sends, and what it makes of each answer.
#include "reader/advannet_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/scripted_http_client.hpp"
#include "tests/reader/advannet_rig.hpp"
#include "tests/reader/allocation_count.hpp"

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

struct Refusal {
  const char* name;
  const char* segment;  // where the ERROR comes
  const char* says;     // in the reason
};
class FinalRefusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(FinalRefusals, FailTheLinkWithParameterValueAnswerAndMend) {
  AdvanNetRig rig;
  rig.fake.errors[GetParam().segment] = "PARAMETER_ERROR: value not supported";
  rig.driver.start(rig.now);
  rig.run(2s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("AdvanReader AdvanReader-m4-160 at 192.168.1.50:3161: "));
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("answered PARAMETER_ERROR: value not supported"));
  EXPECT_THAT(rig.driver.link().reason, HasSubstr(GetParam().says));
  const std::size_t sent = rig.fake.requests.size();
  rig.run(120s);
  EXPECT_EQ(rig.fake.requests.size(), sent) << "a refused plan is not tried again";
  EXPECT_EQ(rig.fake.status, "STOPPED");

  rig.fake.errors.clear();  // a person acted
  rig.driver.start(rig.now);
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
}

INSTANTIATE_TEST_SUITE_P(
    EveryStep, FinalRefusals,
    ::testing::Values(Refusal{"stop", "stop", "GET stop"},
                      Refusal{"mode", "activeDeviceMode", "PUT activeDeviceMode = Autonomous"},
                      Refusal{"read_mode", "readModes%5B0%5D", "Change [reader] on_time"},
                      Refusal{"antennas", "antennas", "Change [reader] ports"},
                      Refusal{"power", "RF_READ_POWER", "PUT RF_READ_POWER = 30"},
                      Refusal{"power_key", "RF_READ_POWER", "Change [reader] power_dbm"},
                      Refusal{"sensitivity", "RF_SENSITIVITY", "PUT RF_SENSITIVITY = -70"},
                      Refusal{"session", "GEN2_SESSION", "PUT GEN2_SESSION = S1"},
                      Refusal{"target", "GEN2_TARGET", "PUT GEN2_TARGET = A"},
                      Refusal{"q", "GEN2_Q", "PUT GEN2_Q = Q_DYNAMIC"},
                      Refusal{"start", "start", "GET start"}),
    [](const auto& refusal) { return refusal.param.name; });

class PassingRefusals : public ::testing::TestWithParam<const char*> {};

TEST_P(PassingRefusals, AreTriedAgainAfterAWait) {
  AdvanNetRig rig;
  rig.fake.errors[GetParam()] = "COMMUNICATIONS_ERROR: module does not answer";
  rig.driver.start(rig.now);
  rig.run(5s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("answered COMMUNICATIONS_ERROR"));
  EXPECT_LE(rig.fake.count("GET /devices"), 4U) << "with a back-off";
  rig.fake.errors.clear();
  rig.run(10s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_TRUE(rig.driver.link().reason.empty());
}

INSTANTIATE_TEST_SUITE_P(EveryStep, PassingRefusals,
                         ::testing::Values("devices", "stop", "activeDeviceMode", "readModes%5B0%5D",
                                           "antennas", "RF_READ_POWER", "GEN2_SESSION", "GEN2_Q", "start"));

TEST(AdvanNetReader, NiceToKnowIsNotNeeded) {
  auto config = rig_config();
  config.read_inputs = true;
  AdvanNetRig rig(config);
  (void)rig.driver.gpo(1);
  for (const char* segment : {"status", "DATA_GPO_NUMBER", "getGPIAll"})
    rig.fake.errors[segment] = "UNKNOWN_OPERATION: not in this firmware";
  rig.open();
}

TEST(AdvanNetReader, SettingThatDoesNotStickFailsTheLink) {
  AdvanNetRig rig;
  rig.fake.read_back["GEN2_SESSION"] = "S0";
  rig.driver.start(rig.now);
  rig.run(2s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("GEN2_SESSION: reads back S0 after S1 was written"));
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("Change [reader] session"));
  EXPECT_EQ(rig.fake.count("GET start"), 0U);
}

TEST(AdvanNetReader, UnsoundPlanOrConfigIsRefusedBeforeAnythingIsSent) {
  auto plan = rig_plan();
  plan.power_dbm = 40;
  AdvanNetRig hot(rig_config(), plan);
  hot.driver.start(hot.now);
  EXPECT_EQ(hot.driver.link().phase, LinkPhase::failed);
  EXPECT_THAT(hot.driver.link().reason, HasSubstr("[reader] power_dbm = 40: above 31.5 dBm"));
  auto config = rig_config();
  config.stream_timeout = 5s;
  AdvanNetRig hasty(config);
  hasty.driver.start(hasty.now);
  EXPECT_THAT(hasty.driver.link().reason, HasSubstr("keep-alive"));
  hasty.run(1s);
  EXPECT_TRUE(hasty.fake.requests.empty());
}

TEST(AdvanNetReader, OneLostAnswerIsRepeatedAndTheLinkStillOpens) {
  AdvanNetRig rig;
  rig.fake.silent = true;
  rig.driver.start(rig.now);
  rig.run(2500ms);
  rig.fake.silent = false;
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_EQ(rig.driver.counters().repeats, 1U);
  EXPECT_FALSE(rig.fake.overlapped);
}

TEST(AdvanNetReader, SilentServerTimesOutWithAReason) {
  AdvanNetRig rig;
  rig.fake.silent = true;
  rig.driver.start(rig.now);
  rig.run(4500ms);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("GET /devices: no answer in time (tried 2 times)"));
}

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
