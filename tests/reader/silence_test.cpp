#include "reader/silence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace forager::reader {
namespace {

using testing::HasSubstr;
using testing::Not;

SilenceFacts listening() {
  SilenceFacts facts;
  facts.link.phase = LinkPhase::open;
  facts.plan.ports = {{4, "front", 0.0, {}, {}}, {2, "right", 0.0, {}, {}}};
  return facts;
}

TEST(WhySilent, ALinkThatIsNotOpenComesFirst) {
  SilenceFacts facts = listening();
  facts.plan.power_dbm = 5.0;  // would be the cause, if the link were there
  facts.link.phase = LinkPhase::lost;
  facts.link.reason = "nobody listens there";
  EXPECT_EQ(why_silent(facts), "the link is down: nobody listens there");
  facts.link.phase = LinkPhase::failed;
  EXPECT_EQ(why_silent(facts), "the link has failed: nobody listens there");
  facts.link.phase = LinkPhase::opening;
  EXPECT_THAT(why_silent(facts), HasSubstr("not started yet"));
  facts.link = {};
  EXPECT_EQ(why_silent(facts), "not started");
}

TEST(WhySilent, AStreamThatNeverSpokeIsNoSilenceOfTags) {
  SilenceFacts facts = listening();
  facts.link.speaks = false;
  EXPECT_THAT(why_silent(facts), HasSubstr("said nothing yet"));
}

TEST(WhySilent, ReadsThatHadToBeDroppedAreNamed) {
  SilenceFacts facts = listening();
  facts.reads_dropped = 12;
  EXPECT_THAT(why_silent(facts), HasSubstr("12 reads came"));
  facts.reads_dropped = 0;
  facts.bad_items = 3;
  EXPECT_THAT(why_silent(facts), HasSubstr("XML_V2_3"));
}

TEST(WhySilent, WhatTheReaderSaysOfItselfCounts) {
  SilenceFacts facts = listening();
  facts.reader_says = "ADVANNET_READER_ERROR: antenna 2 has a high return loss";
  EXPECT_THAT(why_silent(facts), HasSubstr("antenna 2 has a high return loss"));
}

TEST(WhySilent, ASessionKeepsTagsSilentOnlyIfTheyWereReadAndOneFlagIsAskedFor) {
  SilenceFacts facts = listening();
  facts.tags_before = 40;
  for (const Session session : {Session::s1, Session::s2, Session::s3}) {
    facts.plan.session = session;
    facts.plan.target = Target::a;
    EXPECT_THAT(why_silent(facts), HasSubstr("keeps tags silent"));
    facts.plan.target = Target::ab;
    EXPECT_THAT(why_silent(facts), Not(HasSubstr("silent")));
  }
  facts.plan.session = Session::s0;
  facts.plan.target = Target::a;
  EXPECT_THAT(why_silent(facts), Not(HasSubstr("silent")));
  EXPECT_THAT(why_silent(facts), HasSubstr("cable"));
}

TEST(WhySilent, LowPowerIsSuspectedFromHalfTheReachOn) {
  EXPECT_NEAR(relative_reach(30.0), 1.0, 1e-12);
  EXPECT_NEAR(relative_reach(10.0), 0.1, 1e-12);
  SilenceFacts facts = listening();
  facts.plan.power_dbm = 10.0;
  EXPECT_THAT(why_silent(facts), HasSubstr("10 dBm reaches 10 % as far as 30 dBm"));
  facts.plan.power_dbm = 24.5;
  EXPECT_THAT(why_silent(facts), Not(HasSubstr("power")));
  facts.plan.power_dbm = 10.0;
  facts.plan.ports[1].power_dbm = 30.0;  // one antenna with enough
  EXPECT_THAT(why_silent(facts), Not(HasSubstr("power")));
}

TEST(WhySilent, AHighThresholdIsSuspected) {
  SilenceFacts facts = listening();
  facts.plan.sensitivity_dbm = -40.0;
  EXPECT_THAT(why_silent(facts), HasSubstr("weaker than -40 dBm"));
}

TEST(WhySilent, AtLastAntennasAreNamedWithTheirPorts) {
  SilenceFacts facts = listening();
  EXPECT_THAT(why_silent(facts), HasSubstr("no antenna at port 4, 2"));
  EXPECT_THAT(why_silent(facts), Not(HasSubstr("session")));
  facts.plan.session = Session::s2;
  EXPECT_THAT(why_silent(facts), HasSubstr("session S2"));
}

}  // namespace
}  // namespace forager::reader
