#include "flight/interlocks.hpp"

#include <gtest/gtest.h>

#include "mocks/text_journal.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

struct Core {
  mocks::TextJournal journal;
  Interlocks interlocks{journal};
  Instant now{};

  void all_good() {
    for (const InterlockRule& rule : kInterlockTable) interlocks.say(rule.interlock, true);
    step();
  }
  void step() {
    interlocks.update(now);
    now += 10ms;
  }
};

TEST(Interlocks, ForbidEverythingBeforeAnythingWasSaid) {
  Core core;
  core.step();
  EXPECT_FALSE(core.interlocks.may_arm());
  EXPECT_FALSE(core.interlocks.may_thrust());
  EXPECT_FALSE(core.interlocks.tripped()) << "what never held cannot be lost";
  EXPECT_EQ(core.journal.count("lost"), 0U);
}

TEST(Interlocks, AllowArmingAndThrustWhenEveryRowHolds) {
  Core core;
  core.all_good();
  EXPECT_TRUE(core.interlocks.may_arm());
  EXPECT_TRUE(core.interlocks.may_thrust());
  EXPECT_EQ(core.interlocks.first_lost(), nullptr);
}

// Every row of the table does what its columns say.
TEST(Interlocks, EachRowDoesWhatItsColumnsSay) {
  for (const InterlockRule& rule : kInterlockTable) {
    Core core;
    core.all_good();
    core.interlocks.say(rule.interlock, false, "for a test");
    core.step();
    const auto name = to_string(rule.interlock);
    EXPECT_FALSE(core.interlocks.may_thrust()) << name;
    EXPECT_EQ(core.interlocks.may_arm(), !rule.to_arm) << name;
    EXPECT_EQ(core.interlocks.tripped(), rule.latches) << name;
    EXPECT_EQ(core.interlocks.must_disarm(), rule.latches && rule.disarms) << name;
    EXPECT_EQ(core.interlocks.first_lost()->interlock, rule.interlock) << name;
    EXPECT_EQ(core.interlocks.first_latched() != nullptr, rule.latches) << name;
    EXPECT_EQ(core.journal.count("for a test"), 1U) << name;

    core.interlocks.say(rule.interlock, true);
    core.step();
    EXPECT_EQ(core.interlocks.may_thrust(), !rule.latches) << name << ": what latches stays lost";
    core.interlocks.reset(core.now);
    core.step();
    EXPECT_TRUE(core.interlocks.may_thrust()) << name;
  }
}

TEST(Interlocks, NoteAChangeOnceAndNotEveryUpdate) {
  Core core;
  core.all_good();
  core.interlocks.say(Interlock::pose, false);
  for (int i = 0; i < 50; ++i) core.step();
  EXPECT_EQ(core.journal.count("pose lost"), 1U);
  EXPECT_EQ(core.interlocks.lost_since(), Instant{10ms});
}

TEST(Interlocks, AResetDoesNotHelpWhereTheConditionStillFails) {
  Core core;
  core.all_good();
  core.interlocks.say(Interlock::emergency_stop, false, "button pressed");
  core.step();
  core.interlocks.reset(core.now);
  core.step();
  EXPECT_FALSE(core.interlocks.may_thrust());
  EXPECT_FALSE(core.interlocks.may_arm());
}

TEST(Interlocks, NameTheFirstRowOfTheTableThatIsLost) {
  Core core;
  core.all_good();
  core.interlocks.say(Interlock::command, false);
  core.interlocks.say(Interlock::brakes, false);
  core.step();
  EXPECT_EQ(core.interlocks.first_lost()->interlock, Interlock::brakes);
}

}  // namespace
}  // namespace forager::flight
