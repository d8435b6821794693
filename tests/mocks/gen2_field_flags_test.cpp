#include "mocks/gen2_field_flags.hpp"

#include <gtest/gtest.h>

namespace forager::mocks {
namespace {

class SessionFlagsTest : public ::testing::Test {
 protected:
  // Timers of exactly 1 s (S1) and 3 s (S2, S3).
  static AirParameters timers() {
    AirParameters air;
    air.s1_persistence_min_s = air.s1_persistence_max_s = 1.0;
    air.s2_persistence_min_s = air.s2_persistence_max_s = 3.0;
    return air;
  }
  SessionFlags flags_{2, timers(), 1};
};

TEST_F(SessionFlagsTest, ANewTagIsAInEverySession) {
  for (int session = 0; session < 4; ++session) {
    EXPECT_TRUE(flags_.answers(0, session, 'A', 0.0, 1));
    EXPECT_FALSE(flags_.answers(0, session, 'B', 0.0, 1));
    EXPECT_TRUE(flags_.answers(0, session, '*', 0.0, 1));
  }
}

TEST_F(SessionFlagsTest, S0LastsOneDwell) {
  flags_.singulate(0, 0, 'A', 5.0, 9, 5.0);
  EXPECT_FALSE(flags_.answers(0, 0, 'A', 5.01, 9));
  EXPECT_TRUE(flags_.answers(0, 0, 'B', 5.01, 9));
  EXPECT_TRUE(flags_.answers(0, 0, 'A', 5.02, 10));
  EXPECT_TRUE(flags_.answers(1, 0, 'A', 5.01, 9)) << "its neighbour was not counted";
}

TEST_F(SessionFlagsTest, S1RunsOutAlthoughTheTagIsPowered) {
  flags_.singulate(0, 1, 'A', 5.0, 9, 5.0);
  flags_.set_power(0, true, 5.5);
  EXPECT_FALSE(flags_.answers(0, 1, 'A', 5.99, 20));
  EXPECT_TRUE(flags_.answers(0, 1, 'A', 6.0, 20));
  EXPECT_TRUE(flags_.answers(0, 0, 'A', 5.5, 20)) << "sessions are independent";
}

TEST_F(SessionFlagsTest, S2AndS3LastWhilePoweredAndTheirTimeBeyond) {
  for (const int session : {2, 3}) {
    SessionFlags flags(1, timers(), 1);
    flags.singulate(0, session, 'A', 5.0, 9, 5.0);
    EXPECT_TRUE(flags.needs_power_watch());
    EXPECT_FALSE(flags.answers(0, session, 'A', 1000.0, 99));
    flags.set_power(0, false, 1000.0);
    EXPECT_FALSE(flags.answers(0, session, 'A', 1002.9, 99));
    flags.set_power(0, true, 1002.9);
    EXPECT_FALSE(flags.answers(0, session, 'A', 1500.0, 99)) << "power in time renews it";
    flags.set_power(0, false, 1500.0);
    EXPECT_TRUE(flags.answers(0, session, 'A', 1503.0, 99));
    flags.set_power(0, true, 1504.0);
    EXPECT_TRUE(flags.answers(0, session, 'A', 1504.0, 99)) << "power too late does not bring it back";
  }
}

TEST_F(SessionFlagsTest, TargetBCountsTagsBackToA) {
  flags_.singulate(0, 2, 'A', 5.0, 9, 5.0);
  EXPECT_TRUE(flags_.answers(0, 2, 'B', 6.0, 10));
  flags_.singulate(0, 2, 'B', 6.0, 10, 6.0);
  EXPECT_FALSE(flags_.answers(0, 2, 'B', 6.5, 10));
  EXPECT_TRUE(flags_.answers(0, 2, 'A', 6.5, 10));
}

TEST_F(SessionFlagsTest, BothTargetsInTurnHearATagOncePerRound) {
  flags_.singulate(0, 2, '*', 5.0, 9, 5.014);
  EXPECT_FALSE(flags_.answers(0, 2, '*', 5.013, 9));
  EXPECT_TRUE(flags_.answers(0, 2, '*', 5.014, 9));
}

TEST(SessionFlagsSpread, TimersLieWithinTheStandardAndDifferBetweenTags) {
  SessionFlags flags(2000, AirParameters{}, 3);
  int early = 0;
  int middle = 0;
  for (std::uint32_t tag = 0; tag < 2000; ++tag) {
    flags.singulate(tag, 1, 'A', 0.0, 1, 0.0);
    early += flags.answers(tag, 1, 'A', 0.499, 2) ? 1 : 0;
    middle += flags.answers(tag, 1, 'A', 2.75, 2) ? 1 : 0;
    EXPECT_TRUE(flags.answers(tag, 1, 'A', 5.0, 2));
  }
  EXPECT_EQ(early, 0);
  EXPECT_NEAR(middle, 1000, 90);  // binomial deviation 22
}

}  // namespace
}  // namespace forager::mocks
