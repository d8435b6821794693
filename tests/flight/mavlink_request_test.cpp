#include "flight/mavlink_request.hpp"

#include <gtest/gtest.h>

#include "tests/flight/mavlink_bench_autopilot.hpp"

// The command protocol, over the wire and through the whole bridge.
namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::AutopilotBench;
namespace peer = mocks::peer;

constexpr std::uint8_t kAccepted = 0;
constexpr std::uint8_t kTemporarilyRejected = 1;
constexpr std::uint8_t kFailed = 4;
constexpr std::uint8_t kInProgress = 5;

class MavlinkRequestTest : public ::testing::Test {
 protected:
  void SetUp() override { bench_.connect(); }
  [[nodiscard]] RequestState state() { return bench_.ours().request_state(); }
  [[nodiscard]] const std::string& detail() { return bench_.ours().request_detail(); }

  AutopilotBench bench_;
};

TEST_F(MavlinkRequestTest, EachRequestIsTheCommandArduCopterWants) {
  auto& ours = bench_.ours();
  ours.request_guided(bench_.now());
  bench_.step();
  ours.request_land(bench_.now());
  bench_.step();
  ours.request_arm(bench_.now());
  bench_.step();
  ours.request_disarm(bench_.now());
  bench_.step();
  ours.request_takeoff(1.5, bench_.now());
  bench_.step();
  const auto modes = bench_.commands(peer::kDoSetMode);
  ASSERT_EQ(modes.size(), 2U);
  EXPECT_EQ(modes[0].payload.get<float>(0), 1.0F);
  EXPECT_EQ(modes[0].payload.get<float>(4), 4.0F);
  EXPECT_EQ(modes[1].payload.get<float>(4), 9.0F);
  const auto arms = bench_.commands(peer::kComponentArmDisarm);
  ASSERT_EQ(arms.size(), 2U);
  EXPECT_EQ(arms[0].payload.get<float>(0), 1.0F);
  EXPECT_EQ(arms[1].payload.get<float>(0), 0.0F);
  for (const auto& arm : arms) EXPECT_EQ(arm.payload.get<float>(4), 0.0F) << "never by force";
  const auto takeoffs = bench_.commands(peer::kNavTakeoff);
  ASSERT_EQ(takeoffs.size(), 1U);
  EXPECT_EQ(takeoffs[0].payload.get<float>(24), 1.5F);
  EXPECT_EQ(takeoffs[0].payload.get<std::uint8_t>(30), 1);
}

TEST_F(MavlinkRequestTest, IsAcceptedByItsAckAndNoOther) {
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  EXPECT_EQ(state(), RequestState::pending);
  bench_.send_ack(peer::kSetMessageInterval, kAccepted);
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted, 1, 190);
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted, 255, 191);
  bench_.step();
  EXPECT_EQ(state(), RequestState::pending);
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted);
  bench_.step();
  EXPECT_EQ(state(), RequestState::accepted);
  bench_.clear();
  bench_.run(5s);
  EXPECT_TRUE(bench_.commands(peer::kComponentArmDisarm).empty());
}

TEST_F(MavlinkRequestTest, AnAckWithoutTargetIsForEverybody) {
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted, 0, 0);
  bench_.step();
  EXPECT_EQ(state(), RequestState::accepted);
}

TEST_F(MavlinkRequestTest, RepeatsWithGrowingConfirmationAndGivesUp) {
  bench_.ours().request_arm(bench_.now());
  bench_.run(20s);
  const auto tries = bench_.commands(peer::kComponentArmDisarm);
  ASSERT_EQ(tries.size(), 5U);
  for (std::size_t i = 0; i < tries.size(); ++i) EXPECT_EQ(tries[i].payload.get<std::uint8_t>(32), i);
  EXPECT_EQ(state(), RequestState::refused);
  EXPECT_EQ(detail(), "arming refused: no answer in 5 tries");
  EXPECT_EQ(bench_.journal().count("arming refused: no answer"), 1U);
}

TEST_F(MavlinkRequestTest, InProgressWaitsForTheFinalAck) {
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  bench_.send_ack(peer::kComponentArmDisarm, kInProgress);
  bench_.run(8s);
  EXPECT_EQ(bench_.commands(peer::kComponentArmDisarm).size(), 1U);
  EXPECT_EQ(state(), RequestState::pending);
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted);
  bench_.step();
  EXPECT_EQ(state(), RequestState::accepted);
}

TEST_F(MavlinkRequestTest, TemporarilyRejectedIsTriedAgain) {
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  bench_.send_ack(peer::kComponentArmDisarm, kTemporarilyRejected);
  bench_.run(1100ms);
  EXPECT_EQ(bench_.commands(peer::kComponentArmDisarm).size(), 2U);
  bench_.send_ack(peer::kComponentArmDisarm, kAccepted);
  bench_.step();
  EXPECT_EQ(state(), RequestState::accepted);
}

TEST_F(MavlinkRequestTest, ARefusalTellsTheReasonThatCameBeforeIt) {
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  bench_.send_text(2, "PreArm: VisOdom: not healthy");
  bench_.send_ack(peer::kComponentArmDisarm, kFailed);
  bench_.step();
  EXPECT_EQ(state(), RequestState::refused);
  EXPECT_EQ(detail(), "arming refused: PreArm: VisOdom: not healthy");
  EXPECT_EQ(bench_.ours().state().last_text, "PreArm: VisOdom: not healthy");
}

TEST_F(MavlinkRequestTest, ARefusalWaitsShortlyForAReasonThatComesAfterIt) {
  bench_.send_text(4, "an old warning");
  bench_.step();
  bench_.ours().request_arm(bench_.now());
  bench_.step();
  bench_.send_ack(peer::kComponentArmDisarm, kFailed);
  bench_.run(100ms);
  EXPECT_EQ(state(), RequestState::pending);
  bench_.send_text(6, "just chatter");
  bench_.send_text(2, "Arm: Throttle too high");
  bench_.step();
  EXPECT_EQ(detail(), "arming refused: Arm: Throttle too high");
}

TEST_F(MavlinkRequestTest, ARefusalWithoutAReasonNamesTheResult) {
  bench_.ours().request_takeoff(2.0, bench_.now());
  bench_.step();
  bench_.send_ack(peer::kNavTakeoff, kFailed);
  bench_.run(400ms);
  EXPECT_EQ(detail(), "take-off refused: failed");
}

TEST_F(MavlinkRequestTest, ATakeoffWithoutHeightIsRefusedHere) {
  for (const double height : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    bench_.ours().request_takeoff(height, bench_.now());
    bench_.step();
    EXPECT_EQ(state(), RequestState::refused);
  }
  EXPECT_TRUE(bench_.commands(peer::kNavTakeoff).empty());
}

TEST_F(MavlinkRequestTest, AModeSeenInTheHeartbeatNeedsNoAck) {
  bench_.ours().request_land(bench_.now());
  bench_.step();
  bench_.mode(9);
  bench_.run(1100ms);
  EXPECT_EQ(state(), RequestState::accepted);
}

TEST_F(MavlinkRequestTest, TheAckOfAReplacedModeChangeDoesNotPassForTheNewOne) {
  bench_.mode(5);
  bench_.run(1100ms);
  bench_.ours().request_guided(bench_.now());
  bench_.step();
  bench_.ours().request_land(bench_.now());
  bench_.step();
  bench_.send_ack(peer::kDoSetMode, kAccepted);  // of the first
  bench_.run(200ms);
  EXPECT_EQ(state(), RequestState::pending);
  bench_.mode(9);
  bench_.run(1100ms);
  EXPECT_EQ(state(), RequestState::accepted);
}

TEST_F(MavlinkRequestTest, ALandingUnderWaySurvivesTheOwner) {
  bench_.ours().request_land(bench_.now());
  bench_.owner_alive(false);
  bench_.run(4500ms);
  EXPECT_EQ(bench_.commands(peer::kDoSetMode).size(), 5U);
}

TEST_F(MavlinkRequestTest, HaltDropsTheSetpointAndAsksToLandAtOnce) {
  bench_.ours().set_position({{1, 2, 3}, 0.0, bench_.now() + 1h});
  bench_.run(1s);
  bench_.clear();
  bench_.ours().halt();
  bench_.heartbeats(false);
  bench_.owner_alive(false);
  bench_.step();
  const auto modes = bench_.commands(peer::kDoSetMode);
  ASSERT_GE(modes.size(), 1U);
  EXPECT_EQ(modes[0].payload.get<float>(4), 9.0F);
  bench_.owner_alive(true);
  bench_.run(2s);
  EXPECT_TRUE(bench_.heard(peer::kSetPositionTargetLocalNed).empty());
  const std::size_t sent = bench_.commands(peer::kDoSetMode).size();
  bench_.ours().halt();
  bench_.step();
  EXPECT_LE(bench_.commands(peer::kDoSetMode).size(), sent + 1) << "one halt is as good as two";
}

TEST_F(MavlinkRequestTest, HaltLeavesAVehicleToThePilotWhoTookIt) {
  bench_.mode(5);
  bench_.run(2s);
  bench_.clear();
  bench_.ours().halt();
  bench_.run(1s);
  EXPECT_TRUE(bench_.commands(peer::kDoSetMode).empty());
}

}  // namespace
}  // namespace forager::flight
