// The link over time: losses, restarts, wrong clocks, and what the driver does about them by itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "hal/random.hpp"
#include "tests/reader/advannet_rig.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using test::AdvanNetRig;
using ::testing::HasSubstr;

constexpr std::int64_t kFebruary2016 = 1'455'148'800'000;

TEST(AdvanNetLink, KeepAlivesAloneKeepItOpen) {
  AdvanNetRig rig;
  rig.open();
  rig.run(120s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.driver.link().losses, 0U);
  EXPECT_GE(rig.driver.stream_counters().keepalives, 23U);
  EXPECT_LE(rig.now - rig.driver.link().last_heard, hal::Duration(5s + 10ms));
}

TEST(AdvanNetLink, SilenceIsALossWithinTheTimeoutAndHealsWithoutARestart) {
  AdvanNetRig rig;
  rig.open();
  rig.keep_alives = false;
  rig.run(9s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  rig.run(1100ms);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_THAT(
      rig.driver.link().reason,
      HasSubstr("tcp 192.168.1.50:3177: read event stream: nothing for 10.0 s, not even a keep-alive"));
  rig.keep_alives = true;
  rig.run(2s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.driver.link().losses, 1U);
  EXPECT_EQ(rig.driver.counters().reconnects, 1U);
  EXPECT_EQ(rig.driver.counters().configured, 1U) << "it was running with our settings all the time";
  EXPECT_EQ(rig.fake.count("GET start"), 1U);
}

// A port that something else listens to connects as well as a reader does.
TEST(AdvanNetLink, NoiseIsNotAReaderThatFoundNothing) {
  AdvanNetRig rig;
  rig.keep_alives = false;
  rig.open();
  for (int i = 0; i < 95; ++i) {
    rig.fake.send("\x01\xFFSSH-2.0-OpenSSH\r\n220 mail ready\n");
    rig.run(100ms);
    ASSERT_FALSE(rig.driver.link().reading());
  }
  rig.run(1s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("only noise for 10.0 s"));
  rig.keep_alives = true;
  rig.run(7s);
  EXPECT_TRUE(rig.driver.link().reading());
}

TEST(AdvanNetLink, DroppedConnectionDeliversWhatCameBeforeAndReconnects) {
  AdvanNetRig rig;
  rig.open();
  rig.read("aaaa0001");
  rig.fake.wire.drop();
  rig.run(20ms);
  EXPECT_EQ(rig.reads.size(), 1U);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  rig.run(2s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  rig.read("aaaa0002");
  rig.run(20ms);
  EXPECT_EQ(rig.reads.size(), 2U);
}

TEST(AdvanNetLink, RebootedReaderIsConfiguredAndStartedAgain) {
  AdvanNetRig rig;
  auto& lamp = rig.driver.gpo(1);
  rig.open();
  ASSERT_TRUE(lamp.set(true));
  rig.run(10s);
  rig.fake.reboot(rig.now);
  rig.fake.down = true;
  rig.run(25s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::lost);
  EXPECT_THAT(rig.driver.link().reason, HasSubstr("nobody listens"));
  rig.fake.down = false;
  rig.run(20s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
  EXPECT_EQ(rig.fake.parameters["GEN2_SESSION"], "S1");
  EXPECT_EQ(rig.fake.status, "RUNNING");
  EXPECT_TRUE(rig.fake.outputs.at(1)) << "what was wanted before the reboot is wanted after it";
}

// A reboot so quick that no request failed, into a reader that starts by itself: only its uptime tells.
TEST(AdvanNetLink, QuickRebootWithAutostartIsNoticedByTheUptime) {
  AdvanNetRig rig;
  rig.open();
  rig.run(60s);
  const auto parameters = rig.fake.parameters;
  rig.fake.reboot(rig.now);
  rig.fake.parameters = parameters;  // even the settings we ask for look right
  rig.fake.status = "RUNNING";
  rig.run(5s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.driver.counters().configured, 2U);
  EXPECT_EQ(rig.journal.count("the reader was restarted"), 1U);
}

TEST(AdvanNetLink, LostSettingsAreNoticedByReadingThemBack) {
  AdvanNetRig rig;
  rig.fake.booted.reset();  // older firmware: no uptime
  rig.open();
  rig.run(60s);
  rig.fake.reboot(rig.now);
  rig.fake.booted.reset();
  rig.fake.status = "RUNNING";
  rig.run(5s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.fake.parameters["GEN2_SESSION"], "S1");
  EXPECT_EQ(rig.driver.counters().configured, 2U);
}

TEST(AdvanNetLink, ReaderStoppedBySomebodyElseIsStartedAgain) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.status = "STOPPED";  // the stream stays up: keep-alives hide it
  rig.run(10500ms);
  EXPECT_EQ(rig.journal.count("the reader reports STOPPED"), 1U);
  rig.run(2s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.fake.status, "RUNNING");
}

TEST(AdvanNetLink, StopEventIsLookedIntoWithoutWaitingForTheNextCheck) {
  AdvanNetRig rig;
  rig.open();
  rig.run(2s);
  rig.fake.status = "STOPPED";
  rig.fake.send(test::advannet_frame(
      "<deviceEventMessage><event><type>DEVICE_STOP</type><ts>1</ts></event></deviceEventMessage>"));
  rig.run(3s);
  EXPECT_EQ(rig.fake.status, "RUNNING");
}

TEST(AdvanNetLink, ExchangedReaderGetsTheWholePlan) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.ids = {"AdvanReader-m4-160-1b2c"};
  rig.fake.parameters["GEN2_SESSION"] = "S1";
  rig.fake.wire.drop();
  rig.run(3s);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.driver.device().id, "AdvanReader-m4-160-1b2c");
  EXPECT_EQ(rig.driver.counters().configured, 2U);
}

TEST(AdvanNetLink, RestThatDiesWhileTheStreamLivesDoesNotStopTheReads) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.wrong_password = false;
  rig.fake.latency = 10s;  // longer than the request timeout: never an answer
  for (int i = 0; i < 60; ++i) {
    rig.run(1s);
    rig.read("aaaa0001");
  }
  rig.run(10ms);
  EXPECT_EQ(rig.driver.link().phase, LinkPhase::open);
  EXPECT_EQ(rig.reads.size(), 60U);
}

TEST(AdvanNetLink, LossesKeepTheirBeginningAndTheirReason) {
  AdvanNetRig rig;
  rig.open();
  rig.fake.down = true;
  rig.fake.wire.drop();
  rig.run(10ms);
  const hal::Instant since = rig.driver.link().since;
  EXPECT_EQ(since, rig.now);
  rig.run(100s);
  EXPECT_EQ(rig.driver.link().since, since) << "tries in between are no new loss";
  EXPECT_EQ(rig.driver.link().losses, 1U);
  EXPECT_LE(rig.fake.count("GET /devices"), 9U) << "1, 2, 4, ... s";
}

class WrongClock : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(WrongClock, HeardIsOnOurTimeLine) {
  AdvanNetRig rig;
  rig.fake.clock_ms = GetParam();
  rig.open();
  for (int i = 0; i < 50; ++i) {
    rig.run(500ms);
    rig.read("aaaa0001", 30ms);
    const hal::Instant true_time = rig.now - 30ms;
    rig.run(10ms);
    ASSERT_FALSE(rig.driver.reads().empty());
    EXPECT_LE(std::abs((rig.driver.reads()[0].heard - true_time).count()), hal::Duration(12ms).count());
  }
  EXPECT_EQ(rig.driver.counters().stale, 0U);
  EXPECT_EQ(rig.driver.counters().clock_doubts, 0U);
}

INSTANTIATE_TEST_SUITE_P(Epochs, WrongClock,
                         ::testing::Values(1'779'868'340'000, kFebruary2016, std::int64_t{1'000},
                                           std::int64_t{4'102'444'800'000}));

// A reader without a clock battery gets the time from a server while it runs.
TEST(AdvanNetLink, ClockSetForwardMidRunIsFollowed) {
  AdvanNetRig rig;
  rig.fake.clock_ms = kFebruary2016;
  rig.open();
  rig.run(2s);
  rig.fake.clock_ms = 1'779'868'340'000;
  rig.read("aaaa0001");
  rig.run(10ms);
  ASSERT_EQ(rig.reads.size(), 1U);
  EXPECT_EQ(rig.reads[0].heard, rig.reads[0].arrived) << "a time years ahead is not believed";
  rig.run(1500ms);
  EXPECT_EQ(rig.driver.clock().steps(), 1U);
  rig.read("aaaa0002", 40ms);
  rig.run(10ms);
  ASSERT_EQ(rig.reads.size(), 2U);
  EXPECT_NEAR(hal::to_seconds(rig.reads[1].arrived - rig.reads[1].heard), 0.05, 0.012);
  EXPECT_EQ(rig.driver.link().losses, 0U);
}

TEST(AdvanNetLink, ClockSetBackMidRunDoesNotMakeEverythingStale) {
  AdvanNetRig rig;
  rig.open();
  rig.run(25s);
  rig.fake.clock_ms = kFebruary2016;
  for (int i = 0; i < 300; ++i) {
    rig.read("aaaa0001");
    rig.run(10ms);
  }
  EXPECT_LE(rig.driver.counters().stale, 5U) << "until the clock was asked for";
  EXPECT_GE(rig.reads.size(), 295U);
  EXPECT_EQ(rig.driver.link().losses, 0U);
}

// A day of a bad network: every few minutes something breaks. The link always comes back, reads always flow
// again, and nothing piles up.
TEST(AdvanNetLink, TwentyFourHoursOfFlapping) {
  AdvanNetRig rig;
  rig.tick = 100ms;
  rig.open();
  hal::Random random(2024);
  const hal::Instant end = rig.now + 24h;
  std::uint32_t troubles = 0;
  while (rig.now < end) {
    rig.run(hal::from_seconds(random.uniform(20.0, 400.0)));
    ++troubles;
    switch (random.below(5)) {
      case 0:
        rig.fake.wire.drop();
        break;
      case 1:
        rig.fake.reboot(rig.now);
        rig.fake.down = true;
        rig.run(40s);
        break;
      case 2:
        rig.fake.silent = true;
        rig.run(hal::from_seconds(random.uniform(1.0, 30.0)));
        break;
      case 3:
        rig.fake.wire.refuse_connects(true);
        rig.fake.wire.drop();
        rig.run(hal::from_seconds(random.uniform(1.0, 90.0)));
        break;
      default:
        rig.fake.status = "STOPPED";
        break;
    }
    rig.fake.down = rig.fake.silent = false;
    rig.fake.wire.refuse_connects(false);
    rig.run(80s);  // more than the longest back-off
    ASSERT_EQ(rig.driver.link().phase, LinkPhase::open) << rig.driver.link().reason;
    ASSERT_EQ(rig.fake.status, "RUNNING");
    ASSERT_EQ(rig.fake.parameters["GEN2_SESSION"], "S1");
    const std::size_t before = rig.reads.size();
    rig.read("aaaa0001");
    rig.run(100ms);
    ASSERT_EQ(rig.reads.size(), before + 1);
  }
  EXPECT_GT(troubles, 200U);
  EXPECT_FALSE(rig.fake.overlapped);
  EXPECT_GE(rig.driver.counters().reconnects, troubles * 7 / 10);
  EXPECT_LT(rig.fake.requests.size(), std::size_t{troubles} * 80) << "bounded work per trouble";
}

}  // namespace
}  // namespace forager::reader
