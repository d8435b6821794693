// What the driver makes of answers it did not want, and of none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reader/advannet_reader.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using test::AdvanNetRig;
using test::rig_config;
using test::rig_plan;
using ::testing::HasSubstr;

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

}  // namespace
}  // namespace forager::reader
