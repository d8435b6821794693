#include "mocks/gen2_slot_tag.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace forager::mocks {
namespace {

class SlotTagTest : public ::testing::Test {
 protected:
  static AirParameters timers() {
    AirParameters air;
    air.s1_persistence_min_s = air.s1_persistence_max_s = 1.0;
    air.s2_persistence_min_s = air.s2_persistence_max_s = 3.0;
    return air;
  }
  void SetUp() override { tag_.power_on(0.0, 1); }

  static Gen2Query query(std::uint8_t session, std::uint8_t q = 0, Gen2Target target = Gen2Target::a) {
    return {.session = session, .target = target, .q = q};
  }
  // Answers and is acknowledged.
  void acknowledge(std::uint8_t session, double now_s, Gen2Target target = Gen2Target::a) {
    ASSERT_EQ(tag_.query(query(session, 0, target), now_s), TagReply::rn16);
    ASSERT_EQ(tag_.ack(tag_.rn16()), TagReply::epc);
    ASSERT_EQ(tag_.state(), TagState::acknowledged);
  }
  // Draws until the slot is not the first.
  void arbitrate(std::uint8_t session, std::uint8_t q = 4) {
    for (int i = 0; i < 100 && tag_.state() != TagState::arbitrate; ++i)
      (void)tag_.query(query(session, q), 0.0);
    ASSERT_EQ(tag_.state(), TagState::arbitrate);
    ASSERT_GT(tag_.slot(), 0);
    ASSERT_LT(tag_.slot(), 1U << q);
  }

  SessionFlags flags_{1, timers(), 1};
  SlotTag tag_{flags_, 0, 5};
};

TEST_F(SlotTagTest, WithoutPowerItHearsNothing) {
  SlotTag dark(flags_, 0, 1);
  EXPECT_EQ(dark.query(query(0), 0.0), TagReply::nothing);
  EXPECT_EQ(dark.ack(dark.rn16()), TagReply::nothing);
  tag_.power_off(1.0);
  EXPECT_EQ(tag_.query(query(0), 1.0), TagReply::nothing);
}

TEST_F(SlotTagTest, CountsItsSlotDownAndAnswersAtZero) {
  arbitrate(2);
  for (std::uint16_t left = tag_.slot(); left > 1; --left) {
    EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
    EXPECT_EQ(tag_.slot(), left - 1);
  }
  EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::rn16);
  EXPECT_EQ(tag_.state(), TagState::reply);
}

TEST_F(SlotTagTest, AnUnheardReplyWrapsTheCounter) {
  ASSERT_EQ(tag_.query(query(2), 0.0), TagReply::rn16);
  EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
  EXPECT_EQ(tag_.state(), TagState::arbitrate);
  EXPECT_EQ(tag_.slot(), SlotTag::kWrappedSlot);
  EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
  EXPECT_EQ(tag_.slot(), SlotTag::kWrappedSlot - 1);
  EXPECT_EQ(tag_.query_adjust(2, Gen2UpDn::same, 0.0), TagReply::rn16) << "Q 0: the next draw brings it back";
}

TEST_F(SlotTagTest, AnAcknowledgedTagTurnsItsFlagAtTheNextCommand) {
  for (std::uint8_t session = 0; session < 4; ++session) {
    acknowledge(session, 0.0);
    EXPECT_FALSE(tag_.is_b(session, 0.0)) << "not yet";
    EXPECT_EQ(tag_.query_rep(session, 0.0), TagReply::nothing);
    EXPECT_TRUE(tag_.is_b(session, 0.0));
    EXPECT_EQ(tag_.state(), TagState::ready);
    for (std::uint8_t other = static_cast<std::uint8_t>(session + 1); other < 4; ++other)
      EXPECT_FALSE(tag_.is_b(other, 0.0)) << "one flag a session";
  }
}

TEST_F(SlotTagTest, AQueryAdjustTurnsItToo) {
  acknowledge(2, 0.0);
  EXPECT_EQ(tag_.query_adjust(2, Gen2UpDn::up, 0.0), TagReply::nothing);
  EXPECT_TRUE(tag_.is_b(2, 0.0));
  EXPECT_EQ(tag_.state(), TagState::ready);
}

TEST_F(SlotTagTest, AQueryTurnsItAndIsJudgedByTheNewFlag) {
  acknowledge(2, 0.0);
  EXPECT_EQ(tag_.query(query(2), 0.0), TagReply::nothing) << "now B, and A was asked for";
  EXPECT_TRUE(tag_.is_b(2, 0.0));
  EXPECT_EQ(tag_.query(query(2, 0, Gen2Target::b), 0.0), TagReply::rn16);
  EXPECT_EQ(tag_.ack(tag_.rn16()), TagReply::epc);
  EXPECT_EQ(tag_.query(query(2), 0.0), TagReply::rn16) << "B, A, B, ... in turn";
  EXPECT_FALSE(tag_.is_b(2, 0.0));
}

TEST_F(SlotTagTest, CommandsOfAnotherSessionDoNotTurnIt) {
  acknowledge(2, 0.0);
  EXPECT_EQ(tag_.query_rep(1, 0.0), TagReply::nothing);
  EXPECT_EQ(tag_.query_adjust(3, Gen2UpDn::same, 0.0), TagReply::nothing);
  EXPECT_EQ(tag_.state(), TagState::acknowledged);
  EXPECT_EQ(tag_.query(query(1), 0.0), TagReply::rn16) << "a new round elsewhere";
  EXPECT_FALSE(tag_.is_b(2, 0.0));
}

TEST_F(SlotTagTest, AWrongAckIsNotItsOwn) {
  ASSERT_EQ(tag_.query(query(2), 0.0), TagReply::rn16);
  EXPECT_EQ(tag_.ack(static_cast<std::uint16_t>(tag_.rn16() ^ 1U)), TagReply::nothing);
  EXPECT_EQ(tag_.state(), TagState::arbitrate);
  EXPECT_EQ(tag_.ack(tag_.rn16()), TagReply::nothing) << "too late";
  EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
  EXPECT_FALSE(tag_.is_b(2, 0.0));
}

TEST_F(SlotTagTest, NakAndTimeOutPutItBackUncounted) {
  for (int i = 0; i < 2; ++i) {
    acknowledge(2, 0.0);
    i == 0 ? tag_.nak() : tag_.time_out();
    EXPECT_EQ(tag_.state(), TagState::arbitrate);
    EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
    EXPECT_FALSE(tag_.is_b(2, 0.0));
  }
  EXPECT_EQ(tag_.query(query(2, 0, Gen2Target::b), 0.0), TagReply::nothing);
  tag_.nak();
  EXPECT_EQ(tag_.state(), TagState::ready) << "ready is not moved";
}

TEST_F(SlotTagTest, TheSameAckTwiceRepeatsTheEpc) {
  acknowledge(2, 0.0);
  EXPECT_EQ(tag_.ack(tag_.rn16()), TagReply::epc);
}

TEST_F(SlotTagTest, APowerCutBetweenAckAndTheNextCommandLeavesItUncounted) {
  for (std::uint8_t session = 0; session < 4; ++session) {
    acknowledge(session, 0.0);
    tag_.power_off(0.0);
    tag_.power_on(0.0, session + 2U);
    EXPECT_EQ(tag_.state(), TagState::ready);
    EXPECT_EQ(tag_.query_rep(session, 0.0), TagReply::nothing);
    EXPECT_FALSE(tag_.is_b(session, 0.0));
  }
}

TEST_F(SlotTagTest, APowerCutInArbitrateForgetsTheRound) {
  arbitrate(2);
  tag_.power_off(0.0);
  tag_.power_on(0.0, 2);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(tag_.query_rep(2, 0.0), TagReply::nothing);
}

TEST_F(SlotTagTest, S0LastsAsLongAsTheCarrier) {
  acknowledge(0, 0.0);
  (void)tag_.query_rep(0, 0.0);
  EXPECT_TRUE(tag_.is_b(0, 1e6)) << "for ever while powered";
  tag_.power_off(1e6);
  tag_.power_on(1e6, 2);
  EXPECT_FALSE(tag_.is_b(0, 1e6)) << "not even an instant without";
}

TEST_F(SlotTagTest, S1EndsAtItsInstantPoweredOrNot) {
  acknowledge(1, 10.0);
  (void)tag_.query_rep(1, 10.0);
  EXPECT_TRUE(tag_.is_b(1, std::nextafter(11.0, 0.0)));
  EXPECT_FALSE(tag_.is_b(1, 11.0));
  acknowledge(1, 20.0);
  (void)tag_.query_rep(1, 20.0);
  tag_.power_off(20.1);
  tag_.power_on(20.9, 2);
  EXPECT_TRUE(tag_.is_b(1, 20.95));
  EXPECT_FALSE(tag_.is_b(1, 21.0)) << "power does not renew it";
}

TEST_F(SlotTagTest, AnS1TimerThatEndsInARoundIsHeededAfterIt) {
  acknowledge(1, 10.0);
  (void)tag_.query_rep(1, 10.0);
  // A round among the B tags begins just before the timer ends.
  ASSERT_EQ(tag_.query(query(1, 0, Gen2Target::b), 10.9), TagReply::rn16);
  EXPECT_TRUE(tag_.is_b(1, 11.5)) << "in the round";
  ASSERT_EQ(tag_.ack(tag_.rn16()), TagReply::epc);
  (void)tag_.query_rep(1, 11.6);
  EXPECT_FALSE(tag_.is_b(1, 11.6)) << "B was turned to A, not A to B";
  // And one that goes on unread: the next Query finds it A.
  acknowledge(1, 20.0);
  (void)tag_.query_rep(1, 20.0);
  ASSERT_EQ(tag_.query(query(1, 0, Gen2Target::b), 20.9), TagReply::rn16);
  EXPECT_EQ(tag_.query_rep(1, 21.5), TagReply::nothing);
  EXPECT_TRUE(tag_.is_b(1, 21.5));
  EXPECT_EQ(tag_.query(query(0), 21.6), TagReply::rn16);
  tag_.power_off(21.7);
  tag_.power_on(21.7, 2);
  EXPECT_FALSE(tag_.is_b(1, 21.7));
}

TEST_F(SlotTagTest, S2AndS3OutlastPowerUpToTheirInstant) {
  for (const std::uint8_t session : {std::uint8_t{2}, std::uint8_t{3}}) {
    const double t = 100.0 * session;
    acknowledge(session, t);
    (void)tag_.query_rep(session, t);
    EXPECT_TRUE(tag_.is_b(session, t + 90.0)) << "for ever while powered";
    tag_.power_off(t + 90.0);
    EXPECT_TRUE(tag_.is_b(session, std::nextafter(t + 93.0, 0.0)));
    tag_.power_on(std::nextafter(t + 93.0, 0.0), 2);
    EXPECT_TRUE(tag_.is_b(session, t + 95.0)) << "power in time renews it";
    tag_.power_off(t + 95.0);
    EXPECT_FALSE(tag_.is_b(session, t + 98.0));
    tag_.power_on(t + 98.0, 3);
    EXPECT_FALSE(tag_.is_b(session, t + 98.0)) << "power at the instant is too late";
    tag_.power_on(t + 98.0, 3);
  }
}

TEST_F(SlotTagTest, SelectSetsEveryFlagInEveryWay) {
  // What the eight actions make of A and B, or of SL and not SL, when the mask matches and when it does not.
  const struct {
    bool set_if_match, clear_if_match, negate_if_match, set_else, clear_else, negate_else;
  } kExpected[8] = {{true, false, false, false, true, false},  {true, false, false, false, false, false},
                    {false, false, false, false, true, false}, {false, false, true, false, false, false},
                    {false, true, false, true, false, false},  {false, true, false, false, false, false},
                    {false, false, false, true, false, false}, {false, false, false, false, false, true}};
  for (std::uint8_t target = 0; target <= 4; ++target)
    for (std::uint8_t action = 0; action < 8; ++action)
      for (const bool matches : {true, false})
        for (const bool before : {true, false}) {
          // Action 0 on all tags sets, 4 clears: the state before.
          tag_.select(target, before ? 0 : 4, true, 0.0);
          tag_.select(target, action, matches, 0.0);
          const bool after = target == 4 ? flags_.selected(0, 0.0) : !tag_.is_b(target, 0.0);
          const auto& e = kExpected[action];
          const bool set = matches ? e.set_if_match : e.set_else;
          const bool clear = matches ? e.clear_if_match : e.clear_else;
          const bool negate = matches ? e.negate_if_match : e.negate_else;
          EXPECT_EQ(after, negate ? !before : set || (before && !clear))
              << int{target} << " " << int{action} << " " << matches << " " << before;
        }
}

TEST_F(SlotTagTest, SelectEndsTheRoundAndQueriesHeedSl) {
  acknowledge(2, 0.0);
  tag_.select(4, 0, true, 0.0);
  EXPECT_EQ(tag_.state(), TagState::ready);
  EXPECT_EQ(tag_.query({.sel = Gen2Select::not_sl, .session = 2, .q = 0}, 0.0), TagReply::nothing);
  EXPECT_EQ(tag_.query({.sel = Gen2Select::sl, .session = 2, .q = 0}, 0.0), TagReply::rn16);
  tag_.power_off(5.0);
  EXPECT_TRUE(flags_.selected(0, std::nextafter(8.0, 0.0)));
  EXPECT_FALSE(flags_.selected(0, 8.0));
}

TEST_F(SlotTagTest, QueryAdjustMovesItsQWithinLimits) {
  arbitrate(2, 15);
  for (int i = 0; i < 20; ++i) (void)tag_.query_adjust(2, Gen2UpDn::up, 0.0);
  for (int i = 0; i < 15; ++i) (void)tag_.query_adjust(2, Gen2UpDn::down, 0.0);
  EXPECT_EQ(tag_.state(), TagState::reply) << "Q 0 leaves one slot";
  EXPECT_EQ(tag_.query_adjust(2, Gen2UpDn::down, 0.0), TagReply::rn16);
  EXPECT_LT(tag_.slot(), 1);
}

}  // namespace
}  // namespace forager::mocks
