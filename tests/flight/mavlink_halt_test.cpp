// What halt() does to a vehicle on wheels, in the air, and in somebody else's hands.
#include <gtest/gtest.h>

#include "tests/flight/mavlink_bench_autopilot.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using test::AutopilotBench;
using test::MavlinkPayload;
namespace peer = mocks::peer;

constexpr std::uint16_t kArmDisarm = 400;  // MAVLink common.xml
constexpr std::uint16_t kSetMode = 176;
constexpr float kForced = 21196.0F;
constexpr float kLand = 9.0F;

class MavlinkHalt : public testing::Test {
 protected:
  MavlinkHalt() {
    bench_.armed(true);
    bench_.connect();
    says(false, 0.0F);
  }
  // Its land detector and how high it is above where it started.
  void says(bool in_air, float height_m) {
    MavlinkPayload landed;
    landed.put<std::uint8_t>(1, in_air ? 2 : 1);
    bench_.send(peer::kExtendedSysState, landed);
    MavlinkPayload position;
    position.f32(12, -height_m);
    bench_.send(peer::kLocalPositionNed, position);
    bench_.send(peer::kAttitude, {});
    bench_.step();
  }
  void roll() {
    bench_.ours().set_attitude({0.3, 0.0, 0.15, bench_.now() + 1h});
    bench_.step();
  }
  std::size_t forced_disarms() {
    std::size_t count = 0;
    for (const auto& command : bench_.commands(kArmDisarm)) count += command.payload.get<float>(4) == kForced;
    return count;
  }
  std::size_t landings() {
    std::size_t count = 0;
    for (const auto& command : bench_.commands(kSetMode)) count += command.payload.get<float>(4) == kLand;
    return count;
  }
  void halt() {
    bench_.clear();
    bench_.ours().halt();
    bench_.run(3s);
  }
  AutopilotBench bench_;
};

TEST_F(MavlinkHalt, StopsTheMotorsOfAVehicleThatRolls) {
  roll();
  says(true, 0.05F);  // a land detector believes that what pushes flies
  roll();
  halt();
  EXPECT_GE(forced_disarms(), 3U);
  EXPECT_EQ(landings(), 0U);
}

TEST_F(MavlinkHalt, LeavesAVehicleAloneThatAPilotTookWhileItRolled) {
  roll();
  bench_.mode(5);  // loiter
  bench_.run(1500ms);
  halt();
  EXPECT_EQ(forced_disarms(), 0U);
  EXPECT_EQ(landings(), 0U);
}

TEST_F(MavlinkHalt, LandsOneThatAPilotFlewUpAndGaveBack) {
  roll();
  bench_.mode(5);
  bench_.run(1500ms);
  bench_.mode(4);
  bench_.run(1500ms);
  says(true, 0.2F);
  halt();
  EXPECT_EQ(forced_disarms(), 0U);
  EXPECT_GE(landings(), 3U);
}

TEST_F(MavlinkHalt, LandsOneThatClimbsAfterItRolled) {
  roll();
  bench_.ours().clear_setpoint();
  bench_.ours().request_takeoff(1.0, bench_.now());
  bench_.step();
  says(true, 0.3F);
  halt();
  EXPECT_EQ(forced_disarms(), 0U) << "motors must not stop in the air";
  EXPECT_GE(landings(), 3U);
}

TEST_F(MavlinkHalt, LandsOneThatIsHigherThanWheelsGo) {
  roll();
  says(true, 1.2F);
  roll();
  halt();
  EXPECT_EQ(forced_disarms(), 0U);
  EXPECT_GE(landings(), 3U);
}

TEST_F(MavlinkHalt, ARequestThatWasDroppedIsNotRepeated) {
  bench_.ours().request_stop_motors(bench_.now());
  bench_.step();
  EXPECT_EQ(forced_disarms(), 1U);
  bench_.ours().cancel_request();
  EXPECT_EQ(bench_.ours().request_state(), RequestState::none);
  bench_.clear();
  bench_.send_ack(kArmDisarm, 0);
  bench_.run(8s);
  EXPECT_EQ(forced_disarms(), 0U);
  EXPECT_EQ(bench_.ours().request_state(), RequestState::none);
}

TEST_F(MavlinkHalt, ACutOfThrustGoesOutWithoutAnotherUpdate) {
  roll();
  bench_.clear();
  bench_.ours().set_attitude({0.0, 0.0, 0.0, bench_.now() + 10ms});  // over by the next update
  bench_.ours().send(bench_.now());
  bench_.step();
  const auto sent = bench_.heard(peer::kSetAttitudeTarget);
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0].payload.get<float>(32), 0.0F);
}

}  // namespace
}  // namespace forager::flight
