#include "reader/advannet_rest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include "tests/reader/advannet_sample.hpp"

namespace forager::reader::advannet {
namespace {

using namespace std::chrono_literals;
using test::advannet_file;
using ::testing::HasSubstr;

constexpr std::string_view kId = "AdvanReader-m4-160";

Reply parsed(std::string_view body, int status = 200) {
  const auto reply = parse_reply({status, std::string(body)});
  EXPECT_TRUE(reply) << describe(reply.error());
  return reply.value_or(Reply{});
}

TEST(AdvanNetRequests, ActionsAreGetsAndSettersPuts) {
  EXPECT_EQ(get_operation(kId, "stop").path, "/devices/AdvanReader-m4-160/stop");
  EXPECT_EQ(get_operation(kId, "stop").method, hal::HttpMethod::get);
  EXPECT_EQ(set_gpo(kId, 1, true).path, "/devices/AdvanReader-m4-160/setGPO/1/true");
  const auto mode = put_device_mode(kId, "Autonomous");
  EXPECT_EQ(mode.method, hal::HttpMethod::put);
  EXPECT_EQ(mode.path, "/devices/AdvanReader-m4-160/activeDeviceMode");
  EXPECT_EQ(mode.body, "Autonomous");
  EXPECT_EQ(mode.content_type, "text/xml");
  const auto session = put_parameter(kId, "GEN2_SESSION", "S1");
  EXPECT_EQ(session.path, "/devices/AdvanReader-m4-160/reader/parameter/GEN2_SESSION");
  EXPECT_EQ(session.body, "S1");
}

TEST(AdvanNetRequests, PathsArePercentEncoded) {
  ReadPlan plan;
  plan.on_time = 600ms;
  EXPECT_EQ(put_read_mode(kId, plan).path, "/devices/AdvanReader-m4-160/readModes%5B0%5D");
  EXPECT_EQ(get_operation("my reader/1?", "start").path, "/devices/my%20reader%2F1%3F/start");
}

TEST(AdvanNetRequests, AntennasAreThePlansPorts) {
  ReadPlan plan;
  plan.ports = {{1, "front", 0.0, 30.0, -70.0}, {2, "left", 1.57, {}, {}}, {7, "", 0.0, 27.5, {}}};
  EXPECT_EQ(put_antennas(kId, plan).body,
            "<request><entries>"
            "<entry><class>ANTENNA_DEFINITION</class><def>AdvanReader-m4-160,1,0,0,-1,front,0,0,0</def>"
            "<conf><class>ANTENNA_CONF</class><power>30</power><sensitivity>-70</sensitivity><readTime/></"
            "conf></entry>"
            "<entry><class>ANTENNA_DEFINITION</class><def>AdvanReader-m4-160,2,0,0,-1,left,0,0,0</def>"
            "<conf><class>ANTENNA_CONF</class><power/><sensitivity/><readTime/></conf></entry>"
            "<entry><class>ANTENNA_DEFINITION</class><def>AdvanReader-m4-160,7,0,0,-1,port7,0,0,0</def>"
            "<conf><class>ANTENNA_CONF</class><power>27.5</power><sensitivity/><readTime/></conf></entry>"
            "</entries></request>");
}

TEST(AdvanNetRequests, ReadModeCarriesTheRadioTimes) {
  ReadPlan plan;
  plan.on_time = 400ms;
  plan.off_time = 75ms;
  const std::string body = put_read_mode(kId, plan).body;
  EXPECT_THAT(body, HasSubstr("<class>READMODE_AUTONOMOUS</class><name>AUTONOMOUS</name>"));
  EXPECT_THAT(body, HasSubstr("<onTime>400</onTime><offTime>75</offTime>"));
}

TEST(AdvanNetRequests, SettingsSayWhatThePlanSays) {
  ReadPlan plan;
  plan.session = Session::s2;
  plan.target = Target::ab;
  plan.power_dbm = 27.5;
  plan.sensitivity_dbm = -70;
  std::string all;
  for (const auto& setting : settings_of(plan)) all += std::string(setting.name) + "=" + setting.value + " ";
  EXPECT_EQ(all, "RF_READ_POWER=27.5 RF_SENSITIVITY=-70 GEN2_SESSION=S2 GEN2_TARGET=AB GEN2_Q=Q_DYNAMIC ");
  plan.q = 4;
  EXPECT_EQ(settings_of(plan).back().value, "Q_4");
}

TEST(AdvanNetRequests, AreNamedAsAPersonWouldSay) {
  EXPECT_EQ(describe_request(put_parameter(kId, "GEN2_SESSION", "S1")), "PUT GEN2_SESSION = S1");
  EXPECT_EQ(describe_request(get_operation(kId, "start")), "GET start");
  EXPECT_EQ(describe_request(put_antennas(kId, {})), "PUT antennas");
  EXPECT_EQ(describe_request(get_devices()), "GET /devices");
}

TEST(AdvanNetValues, NumbersCompareByValue) {
  EXPECT_TRUE(same_value("30", "30.0"));
  EXPECT_TRUE(same_value("-70", "-70.00"));
  EXPECT_FALSE(same_value("30", "29.5"));
  EXPECT_FALSE(same_value("S1", "S0"));
  EXPECT_FALSE(same_value("S1", "1"));
}

TEST(AdvanNetReplies, DeviceListOfARealReader) {
  const Reply reply = parsed(advannet_file("devices.xml"));
  EXPECT_TRUE(reply.ok);
  EXPECT_EQ(reply.ts_ms, 1779868340000);
  ASSERT_EQ(reply.devices.size(), 1U);
  EXPECT_EQ(reply.devices[0].id, kId);
  EXPECT_EQ(reply.devices[0].serial, "0091104::64cfd9c7561c");
  EXPECT_EQ(reply.devices[0].family, "AdvanReader");
  EXPECT_EQ(reply.devices[0].status, "RUNNING");
}

TEST(AdvanNetReplies, SingleDeviceMayHangAlone) {
  const Reply reply = parsed(
      "<response><status>OK</status><data><device><id>a</id><status>STOPPED</status></device></data></"
      "response>");
  ASSERT_EQ(reply.devices.size(), 1U);
  EXPECT_EQ(reply.devices[0].status, "STOPPED");
}

TEST(AdvanNetReplies, StatusGivesTheUptime) {
  EXPECT_EQ(parsed(advannet_file("status.xml")).uptime, hal::Duration(2h + 49min + 33s));
  const auto of = [](std::string text) {
    return parsed("<response><status>OK</status><data><uptime>" + text + "</uptime></data></response>")
        .uptime;
  };
  EXPECT_EQ(of("3d 00h 00m 01s"), hal::Duration(72h + 1s));
  for (const char* odd : {"", "soon", "12", "12x", "99999999999999s", "1h-2m"}) EXPECT_FALSE(of(odd)) << odd;
}

TEST(AdvanNetReplies, ErrorHasItsCodeWhateverTheHttpStatus) {
  for (const int status : {200, 400, 500}) {
    const Reply reply = parsed(
        "<response><type>response</type><ts>1779868346999</ts><status>ERROR</status><op>info</op>"
        "<msg>UNKNOWN_OPERATION: Operation [info] unknown.</msg></response>",
        status);
    EXPECT_FALSE(reply.ok);
    EXPECT_EQ(reply.code, "UNKNOWN_OPERATION");
    EXPECT_EQ(describe_refusal(reply), "answered UNKNOWN_OPERATION: Operation [info] unknown.");
    EXPECT_EQ(reply.ts_ms, 1779868346999);
  }
  EXPECT_EQ(parsed("<response><status>ERROR</status><msg>just words: here</msg></response>").code, "");
}

TEST(AdvanNetReplies, OuterResponseMayBeMissing) {
  const Reply reply = parsed("<data><result>S1</result></data>");
  EXPECT_TRUE(reply.ok);
  EXPECT_EQ(reply.result, "S1");
  EXPECT_TRUE(parsed("<status>OK</status><ts>5</ts><data><result>x</result></data>").ok);
}

TEST(AdvanNetReplies, InputsCountFromOne) {
  const Reply reply = parsed(
      "<response><status>OK</status><data><entries><entry><index>0</index><result>true</result></entry>"
      "<entry><index>3</index><result>false</result></entry></entries></data></response>");
  ASSERT_EQ(reply.inputs.size(), 2U);
  EXPECT_EQ(reply.inputs[0].line, 1U);
  EXPECT_TRUE(reply.inputs[0].high);
  EXPECT_EQ(reply.inputs[1].line, 4U);
}

TEST(AdvanNetReplies, OtherServersAreNotMistakenForAReader) {
  for (const char* body : {"", "<html><body>It works!</body></html>", "plain", "{\"a\":1}", "<response/>"}) {
    const auto reply = parse_reply({200, body});
    ASSERT_FALSE(reply) << body;
    EXPECT_EQ(reply.error().code, hal::ErrorCode::protocol);
    EXPECT_THAT(describe(reply.error()), HasSubstr("3161"));
  }
  EXPECT_FALSE(parse_reply({500, "<html>Internal error</html>"}));
}

TEST(AdvanNetReplies, HostileBodiesAreHarmless) {
  std::string deep = "<response><status>OK</status><data>";
  for (int i = 0; i < 200'000; ++i) deep += "<a>";
  EXPECT_FALSE(parse_reply({200, deep}));
  EXPECT_FALSE(parse_reply({200, std::string(5U << 20U, ' ')}));
  const Reply bomb = parsed(
      "<!DOCTYPE a [<!ENTITY x "
      "\"xxxxxxxx\">]><response><status>OK</status><data><result>&x;</result></data></response>");
  EXPECT_EQ(bomb.result, "&x;");
  EXPECT_EQ(parsed("<response><ts>-5</ts><status>OK</status><data/></response>").ts_ms, std::nullopt);
  EXPECT_EQ(parsed("<response><ts>99999999999999999999</ts><status>OK</status><data/></response>").ts_ms,
            std::nullopt);
}

RC_GTEST_PROP(AdvanNetRequestsProperty, EncodedSegmentNeverLeavesItsPlace, (const std::string& id)) {
  const std::string encoded = percent_encode(id);
  RC_ASSERT(encoded.find_first_of("/?#[] %") == std::string::npos || encoded.find('%') != std::string::npos);
  for (const char c : encoded)
    RC_ASSERT((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
              c == '.' || c == '_' || c == '~' || c == '%');
}

}  // namespace
}  // namespace forager::reader::advannet
