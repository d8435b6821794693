#include "reader/read_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "reader/tag_reader.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

ReadPlan sound_plan() {
  ReadPlan plan;
  plan.on_time = 600ms;
  plan.off_time = 0ms;
  plan.ports = {{4, "front", 0.0, 27.5, {}}, {2, "right", -1.5708, {}, -60.0}};
  return plan;
}

TEST(ReadPlan, SoundPlanIsAccepted) {
  const auto valid = validate(sound_plan());
  EXPECT_TRUE(valid) << describe(valid.error());
}

struct BadPlan {
  const char* name;
  std::function<void(ReadPlan&)> spoil;
  const char* says;
};

class BadPlans : public ::testing::TestWithParam<BadPlan> {};

TEST_P(BadPlans, AreRefusedWithFieldAndLimit) {
  ReadPlan plan = sound_plan();
  GetParam().spoil(plan);
  const auto valid = validate(plan);
  ASSERT_FALSE(valid);
  EXPECT_EQ(valid.error().code, hal::ErrorCode::invalid_argument);
  EXPECT_THAT(describe(valid.error()), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadPlans,
    ::testing::Values(
        BadPlan{"hot", [](ReadPlan& p) { p.power_dbm = 40; }, "[reader] power_dbm = 40: above 31.5 dBm"},
        BadPlan{"cold", [](ReadPlan& p) { p.power_dbm = -0.5; }, "below 0 dBm"},
        BadPlan{"step", [](ReadPlan& p) { p.power_dbm = 27.3; }, "27.3: not a step of 0.5"},
        BadPlan{"nan", [](ReadPlan& p) { p.power_dbm = std::numeric_limits<double>::quiet_NaN(); },
                "is not a number"},
        BadPlan{"deaf", [](ReadPlan& p) { p.sensitivity_dbm = -10; }, "sensitivity_dbm = -10: above -20"},
        BadPlan{"noise", [](ReadPlan& p) { p.sensitivity_dbm = -91; }, "below -90"},
        BadPlan{"q", [](ReadPlan& p) { p.q = 16; }, "q = 16: outside 1 to 15"},
        BadPlan{"unset", [](ReadPlan& p) { p.on_time = 0ms; }, "on_time_ms = 0: not a whole"},
        BadPlan{"long", [](ReadPlan& p) { p.on_time = 3001ms; }, "from 50 to 3000"},
        BadPlan{"fraction", [](ReadPlan& p) { p.on_time = 600ms + 1us; }, "on_time_ms = 600.001"},
        BadPlan{"off", [](ReadPlan& p) { p.off_time = 60ms; }, "0, 10, 20, 30, 40, 50, 75, 100"},
        BadPlan{"none", [](ReadPlan& p) { p.ports.clear(); }, "names no port"},
        BadPlan{"zero", [](ReadPlan& p) { p.ports[0].port = 0; }, "count from 1 to 32"},
        BadPlan{"twice", [](ReadPlan& p) { p.ports[1].port = 4; }, "port = 4: is named twice"},
        BadPlan{"comma", [](ReadPlan& p) { p.ports[0].name = "a,b"; }, "ports[4] name"},
        BadPlan{"markup", [](ReadPlan& p) { p.ports[0].name = "<x>"; }, "plain name"},
        BadPlan{"port_power", [](ReadPlan& p) { p.ports[0].power_dbm = 33; }, "ports[4] power_dbm = 33"},
        BadPlan{"bearing", [](ReadPlan& p) { p.ports[0].bearing_rad = 1.0 / 0.0; }, "bearing_rad = inf"}),
    [](const auto& bad) { return bad.param.name; });

TEST(ReadPlan, PrintsEveryFieldThatDecidesWhatIsOnTheAir) {
  const std::string text = to_string(sound_plan());
  for (const char* part : {"session      S0", "target       A", "dynamic", "power        30 dBm",
                           "sensitivity  -80 dBm", "RF on        600 ms", "RF off       0 ms", "front",
                           "power 27.5 dBm", "sensitivity -60 dBm", "bearing -90 deg"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST(ReadPlan, NamesReadBack) {
  for (const Session session : {Session::s0, Session::s1, Session::s2, Session::s3})
    EXPECT_EQ(session_from(to_string(session)), session);
  for (const Target target : {Target::a, Target::b, Target::ab, Target::ba})
    EXPECT_EQ(target_from(to_string(target)), target);
  EXPECT_THAT(describe(session_from("S4").error()), HasSubstr("[reader] session = \"S4\""));
  EXPECT_FALSE(target_from("a"));
}

TEST(LinkPhase, EveryPhaseHasAName) {
  EXPECT_EQ(to_string(LinkPhase::lost), "lost");
  EXPECT_EQ(to_string(LinkPhase::failed), "failed");
}

}  // namespace
}  // namespace forager::reader
