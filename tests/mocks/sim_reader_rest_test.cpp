// The REST dialogues of the AdvanNet material, word for word, and everything the emulator must refuse.
#include <gmock/gmock.h>

#include "tests/mocks/sim_reader_bench.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::HttpMethod;
using testing::HasSubstr;
using testing::Not;

constexpr std::string_view kTwoAntennas =
    "<request><entries>"
    "<entry><class>ANTENNA_DEFINITION</class><def>AdvanReader-m4-160,1,0,0,-1,front,0,0,0</def>"
    "<conf><class>ANTENNA_CONF</class><power>30</power><sensitivity>-70</sensitivity><readTime/></conf></"
    "entry>"
    "<entry><class>ANTENNA_DEFINITION</class><def>AdvanReader-m4-160,2,0,0,-1,left,0,0,0</def>"
    "<conf><class>ANTENNA_CONF</class><power/><sensitivity/><readTime/></conf></entry>"
    "</entries></request>";

std::string ok(std::int64_t ts, std::string_view op, std::string_view data = "") {
  return fmt::format(
      "<response><type>response</type><ts>{}</ts><status>OK</status><msg-version>2.3.0</msg-version>"
      "<op>{}</op>{}</response>",
      ts, op, data.empty() ? std::string() : fmt::format("<data>{}</data>", data));
}

std::string error(std::int64_t ts, std::string_view op, std::string_view msg) {
  return fmt::format(
      "<response><type>response</type><ts>{}</ts><status>ERROR</status><op>{}</op><msg>{}</msg></response>",
      ts, op, msg);
}

struct SimReaderRest : testing::Test {
  SimReaderBench bench;
  // The clock of the bench reader starts at 1779868340000.
  static constexpr std::int64_t kBoot = 1'779'868'340'000;

  void SetUp() override { bench.reader.update(bench.now); }
  void advance_ms(int ms) { bench.now += std::chrono::milliseconds(ms); }
};

TEST_F(SimReaderRest, StopAnswersTheBareEnvelope) {
  advance_ms(100);
  EXPECT_EQ(bench.device_get("stop").body, ok(kBoot + 100, "stop"));
  EXPECT_EQ(bench.device_get("stop").status, 200);
}

TEST_F(SimReaderRest, ModesAreSetAndReadAsPlainText) {
  EXPECT_EQ(bench.device_put("activeDeviceMode", "Autonomous").body, ok(kBoot, "activeDeviceMode"));
  EXPECT_EQ(bench.device_get("activeReadMode").body,
            ok(kBoot, "activeReadMode", "<result>AUTONOMOUS</result>"));
  EXPECT_THAT(bench.device_put("activeDeviceMode", "autonomous").body, HasSubstr("DEVICEMODE_DO_NOT_EXIST"));
  EXPECT_EQ(bench.device_put("activeDeviceMode", "Sequential\r\n").status, 200);
  EXPECT_THAT(bench.device_get("activeReadMode").body, HasSubstr("<result>SEQUENTIAL</result>"));
}

TEST_F(SimReaderRest, ParametersAreReadBackAsTheyWereWritten) {
  EXPECT_THAT(bench.device_get("reader/parameter/RF_READ_POWER").body, HasSubstr("<result>31.5</result>"));
  EXPECT_THAT(bench.device_put("reader/parameter/RF_READ_POWER", "30").body,
              HasSubstr("<status>OK</status>"));
  EXPECT_THAT(bench.device_get("reader/parameter/RF_READ_POWER").body,
              HasSubstr("<data><result>30</result></data>"));
  EXPECT_THAT(bench.device_get("reader/parameter/RF_WRITE_POWER/27.5").body,
              HasSubstr("<status>OK</status>"));
  EXPECT_THAT(
      bench.device_get("reader").body,
      HasSubstr("<RF_WRITE_POWER><result>27.5</result><read-only>false</read-only></RF_WRITE_POWER>"));
  EXPECT_THAT(bench.device_get("reader/params").body, HasSubstr("<ip>/dev/ttyO1</ip><model>M6e</model>"));
}

TEST_F(SimReaderRest, ParametersOutOfRangeUnknownOrReadOnlyAreRefusedAndStay) {
  const std::pair<const char*, const char*> refused[] = {
      {"RF_READ_POWER", "32"},     {"RF_READ_POWER", "30.2"},  {"RF_READ_POWER", "-1"},
      {"RF_READ_POWER", "30 dBm"}, {"RF_READ_POWER", ""},      {"RF_SENSITIVITY", "-91"},
      {"GEN2_SESSION", "0"},       {"GEN2_SESSION", "S4"},     {"GEN2_SESSION", "s1"},
      {"GEN2_TARGET", "C"},        {"GEN2_Q", "Q_16"},         {"RF_POWER", "30"},
      {"RF_ASYNCH_OFFTIME", "15"}, {"RF_ASYNCH_ONTIME", "49"}, {"MCU_GPI_NUMBER", "4"}};
  const std::string before = bench.device_get("reader").body;
  for (const auto& [name, value] : refused)
    EXPECT_THAT(bench.device_put(fmt::format("reader/parameter/{}", name), value).body,
                HasSubstr("<status>ERROR</status>"))
        << name << " " << value;
  EXPECT_THAT(bench.device_put("reader/parameter/RF_PORT_NUMBER", "2").body,
              HasSubstr("OPERATION_NOT_EXECUTED"));
  EXPECT_EQ(bench.device_get("reader").body, before);
}

TEST_F(SimReaderRest, AntennasReplaceTheWholeListAndReadBackInTheSameForm) {
  EXPECT_EQ(bench.device_put("antennas", kTwoAntennas).body, ok(kBoot, "antennas"));
  const std::string list = bench.device_get("antennas").body;
  EXPECT_THAT(list, HasSubstr("<entries><entry><class>ANTENNA_DEFINITION</class>"
                              "<def>AdvanReader-m4-160,1,0,0,-1,front,0,0,0</def><conf>"
                              "<class>ANTENNA_CONF</class><power>30</power><sensitivity>-70</sensitivity>"
                              "<readTime/></conf></entry>"));
  EXPECT_THAT(list, HasSubstr("<power/><sensitivity/><readTime/>"));
  EXPECT_THAT(list, Not(HasSubstr("shelf1")));
}

TEST_F(SimReaderRest, TheExpandedAntennaFormMeansTheSame) {
  const auto reply = bench.device_put(
      "antennas",
      "<request>\n <entries>\n  <entry><class>ANTENNA_DEFINITION</class><cid/><port>3</port><mux1>0</mux1>"
      "<mux2>0</mux2><orientation>-1</orientation><location><class>LOCATION</class><locID>aisle &amp; "
      "7</locID>"
      "<x/><y/><z/></location><conf><class>ANTENNA_CONF</class><power>27.5</power><sensitivity/><readTime/>"
      "</conf></entry>\n </entries></request>");
  EXPECT_THAT(reply.body, HasSubstr("<status>OK</status>"));
  EXPECT_THAT(bench.device_get("antennas").body,
              HasSubstr("<def>AdvanReader-m4-160,3,0,0,-1,aisle &amp; 7,0,0,0</def>"));
}

TEST_F(SimReaderRest, AntennasThatCannotBeAreRefusedAndTheListStays) {
  const std::string before = bench.device_get("antennas").body;
  for (const std::string_view def :
       {"AdvanReader-m4-160,5,0,0,-1,x,0,0,0", "AdvanReader-m4-160,0,0,0,-1,x,0,0,0",
        "AdvanReader-m4-160,1,2,0,-1,x,0,0,0", "AdvanReader-m4-160,1,0,0,2,x,0,0,0",
        "reader,1,0,0,-1,x,0,0,0", "AdvanReader-m4-160,1,0,0,-1,x", "nonsense"})
    EXPECT_THAT(
        bench
            .device_put(
                "antennas",
                fmt::format("<request><entries><entry><def>{}</def></entry></entries></request>", def))
            .body,
        HasSubstr("<msg>PARAMETER_ERROR"))
        << def;
  EXPECT_THAT(bench.device_put("antennas", "hello").body, HasSubstr("INVALID_REQUEST"));
  EXPECT_THAT(bench.device_put("antennas", "<request><entries><entry>").body, HasSubstr("INVALID_REQUEST"));
  EXPECT_EQ(bench.device_get("antennas").body, before);
}

TEST_F(SimReaderRest, ReadModeParametersAreSetByIndexPercentEncodedOrNot) {
  constexpr std::string_view kBody =
      "<request><class>READMODE_AUTONOMOUS</class><name>AUTONOMOUS</name>"
      "<useFastSearch>false</useFastSearch><swFilterOnly>false</swFilterOnly>"
      "<filterMaskOffset>32</filterMaskOffset><filterMaskBitLength>0</filterMaskBitLength><filterMaskHex/>"
      "<calibratorsRefreshPeriod>60</calibratorsRefreshPeriod><keepAllReads>false</keepAllReads>"
      "<asynch>true</asynch><cleanBufferOnSynchRead>false</cleanBufferOnSynchRead>"
      "<timeWindow>2000</timeWindow><onTime>250</onTime><offTime>50</offTime></request>";
  EXPECT_THAT(bench.device_put("readModes%5B0%5D", kBody).body, HasSubstr("<status>OK</status>"));
  EXPECT_THAT(bench.device_get("readModes[0]").body, HasSubstr("<onTime>250</onTime><offTime>50</offTime>"));
  for (const std::string_view bad :
       {"<onTime>49</onTime>", "<offTime>60</offTime>", "<volume>11</volume>",
        "<filterMaskBitLength>8</filterMaskBitLength>", "<name>SEQUENTIAL</name>"})
    EXPECT_THAT(bench.device_put("readModes[0]", fmt::format("<request>{}</request>", bad)).body,
                HasSubstr("<status>ERROR</status>"))
        << bad;
  EXPECT_THAT(bench.device_get("readModes[0]").body, HasSubstr("<onTime>250</onTime><offTime>50</offTime>"));
}

TEST_F(SimReaderRest, SetupIsRefusedWhileRunningUnlessConfiguredOtherwise) {
  bench.device_get("start");
  EXPECT_THAT(bench.device_put("antennas", kTwoAntennas).body, HasSubstr("<msg>OPERATION_NOT_EXECUTED: "));
  EXPECT_THAT(bench.device_put("activeDeviceMode", "Sequential").body, HasSubstr("OPERATION_NOT_EXECUTED"));
  EXPECT_THAT(bench.device_put("readModes[0]", "<request/>").body, HasSubstr("OPERATION_NOT_EXECUTED"));

  SimReaderConfig lenient;
  lenient.refuse_changes_running = false;
  SimReaderBench other(lenient);
  other.device_get("start");
  EXPECT_THAT(other.device_put("antennas", kTwoAntennas).body, HasSubstr("<status>OK</status>"));
  EXPECT_EQ(other.field.settings().ports.size(), 2U);
}

TEST_F(SimReaderRest, OutputsAreOneBasedAndCaseInsensitive) {
  EXPECT_EQ(bench.device_get("setGPO/1/true").body, ok(kBoot, "setGPO"));
  EXPECT_TRUE(bench.reader.gpo(1));
  EXPECT_EQ(bench.device_get("setGPO/9/True").status, 200);
  EXPECT_TRUE(bench.reader.gpo(9));
  bench.device_get("setGPO/1/False");
  EXPECT_FALSE(bench.reader.gpo(1));
  EXPECT_THAT(bench.device_get("setGPO/0/true").body, HasSubstr("<msg>INVALID_GPO_NUMBER"));
  EXPECT_THAT(bench.device_get("setGPO/11/true").body, HasSubstr("<msg>INVALID_GPO_NUMBER"));
  EXPECT_THAT(bench.device_get("setGPO/1/on").body, HasSubstr("<msg>PARAMETER_ERROR"));
  EXPECT_THAT(bench.device_get("setGPO/1").body, HasSubstr("<msg>UNKNOWN_OPERATION"));
  EXPECT_EQ(bench.journal.count("GPO 9 on"), 1U);
}

TEST_F(SimReaderRest, InputsAreListedFromZeroAndAskedFromOne) {
  bench.reader.set_gpi(1, true, bench.now);
  EXPECT_EQ(bench.device_get("getGPIAll").body,
            ok(kBoot, "getGPIAll",
               "<entries><entry><index>0</index><result>true</result></entry>"
               "<entry><index>1</index><result>false</result></entry>"
               "<entry><index>2</index><result>false</result></entry>"
               "<entry><index>3</index><result>false</result></entry></entries>"));
  EXPECT_EQ(bench.device_get("getGPI/1").body, ok(kBoot, "getGPI", "<result>true</result>"));
  EXPECT_THAT(bench.device_get("getGPI/5").body, HasSubstr("<msg>INVALID_GPI_NUMBER"));
  EXPECT_THAT(bench.device_get("gpioAll").body, HasSubstr("<data><GPI1>true</GPI1><GPI2>false</GPI2>"));
  EXPECT_THAT(bench.device_get("gpioAll").body, HasSubstr("<GPO10>false</GPO10></data>"));
}

TEST_F(SimReaderRest, UnknownThingsAreRefusedNeverAnsweredOk) {
  EXPECT_EQ(bench.device_get("bogus").body,
            error(kBoot, "bogus", "UNKNOWN_OPERATION: Operation [bogus] unknown."));
  EXPECT_EQ(bench.get("/devices/simulator/start").body,
            error(kBoot, "start", "UNKNOWN_DEVICE: Device [simulator] unknown."));
  for (const std::string_view path :
       {"/", "/atom", "/Devices", "/devices/AdvanReader-m4-160/Start",
        "/devices/AdvanReader-m4-160/start/now", "/system", "/system/os/FactoryReset", "/conf", "/status/x",
        "/devices/AdvanReader-m4-160/readModes[1]"})
    EXPECT_THAT(bench.get(path).body, HasSubstr("<msg>UNKNOWN_OPERATION")) << path;
  EXPECT_THAT(bench.device_get("%3Cb%3E%01&").body, HasSubstr("<op>&lt;b&gt;?&amp;</op>"));
  EXPECT_THAT(bench.device_put("start", "").body, HasSubstr("UNKNOWN_OPERATION"));
  EXPECT_EQ(bench.reader.status(), SimReader::Status::stopped);
}

TEST_F(SimReaderRest, DevicesTellIdSerialAndFamilyInThisOrder) {
  const std::string devices = bench.get("/devices/").body;
  EXPECT_THAT(devices,
              HasSubstr("<data><devices><device><id>AdvanReader-m4-160</id><ip>192.168.26.120</ip>"
                        "<mac>64:cf:d9:c7:56:1c</mac><serial>0091104::64cfd9c7561c</serial>"
                        "<family>AdvanReader</family><activeDeviceMode>Autonomous</activeDeviceMode>"
                        "<activeReadMode>AUTONOMOUS</activeReadMode><isAlive>true</isAlive>"
                        "<status>STOPPED</status><lastSeen>20260527 0752.20</lastSeen></device></devices>"));
  EXPECT_EQ(bench.get("/devices/all").body, devices);
  EXPECT_THAT(bench.get("/status").body,
              HasSubstr("<version>2.10.33</version><revision>20260317_1530</revision>"));
  EXPECT_THAT(bench.get("/status").body, HasSubstr("<uptime>00h 00m 00s</uptime>"));
}

TEST_F(SimReaderRest, NoSuccessfulAnswerContainsTheWordError) {
  for (const std::string_view path : {"/devices", "/status", "/system/time", "/conf/save"})
    EXPECT_THAT(bench.get(path).body, Not(HasSubstr("ERROR"))) << path;
  for (const std::string_view path :
       {"reader", "antennas", "deviceModes", "readModes[0]", "gpioAll", "start"})
    EXPECT_THAT(bench.device_get(path).body, Not(HasSubstr("ERROR"))) << path;
}

TEST_F(SimReaderRest, TheClockCanBeSet) {
  advance_ms(250);
  EXPECT_EQ(bench.get("/system/time").body, ok(kBoot + 250, "time", "<time>1779868340250</time>"));
  EXPECT_THAT(bench.put("/system/time", "1800000000000").body, HasSubstr("<time>1800000000000</time>"));
  advance_ms(1000);
  EXPECT_EQ(bench.reader.reader_ms(bench.now), 1'800'000'001'000);
  EXPECT_THAT(bench.put("/system/time", "noon").body, HasSubstr("PARAMETER_ERROR"));
}

TEST_F(SimReaderRest, TheStatusOfRefusalsIsASwitch) {
  SimReaderConfig config;
  config.error_http_status = 400;
  SimReaderBench other(config);
  EXPECT_EQ(other.device_get("bogus").status, 400);
  EXPECT_EQ(other.device_get("stop").status, 200);
}

TEST_F(SimReaderRest, InventoryOfAStoppedReaderIsRefused) {
  EXPECT_THAT(bench.device_get("inventory").body,
              HasSubstr("<msg>DEVICE_STOPPED: inventory() device is stopped. Start it before performing any "
                        "operation.</msg>"));
}

TEST_F(SimReaderRest, RebootLosesWhatWasNotSaved) {
  bench.device_put("reader/parameter/GEN2_SESSION", "S2");
  bench.get("/conf/save");
  bench.device_put("reader/parameter/RF_READ_POWER", "20");
  bench.device_get("setGPO/3/true");
  bench.device_get("start");
  EXPECT_THAT(bench.get("/system/runtime/reboot").body, HasSubstr("<status>OK</status>"));
  bench.run_until(10.0);
  EXPECT_FALSE(bench.reader.reachable(bench.now));
  EXPECT_FALSE(bench.field.on());
  bench.run_until(40.0);
  EXPECT_TRUE(bench.reader.reachable(bench.now));
  EXPECT_THAT(bench.device_get("reader/parameter/GEN2_SESSION").body, HasSubstr("<result>S2</result>"));
  EXPECT_THAT(bench.device_get("reader/parameter/RF_READ_POWER").body, HasSubstr("<result>31.5</result>"));
  EXPECT_EQ(bench.reader.status(), SimReader::Status::stopped);
  EXPECT_FALSE(bench.reader.gpo(3));
}

TEST_F(SimReaderRest, AutostartRunsAfterBoot) {
  bench.device_put("parameter/DEVICE_RUNTIME_AUTOSTART", "true");
  bench.device_get("confSave");
  bench.reader.power_cut(bench.now);
  advance_ms(1000);
  bench.reader.power_on(bench.now);
  bench.run_until(60.0);
  EXPECT_EQ(bench.reader.status(), SimReader::Status::running);
  EXPECT_TRUE(bench.field.on());
}

}  // namespace
}  // namespace forager::mocks
