#include "servo/brake_steer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

// A vehicle, a camera and the loop, every 10 ms.
struct Rig {
  explicit Rig(mocks::RollingParameters p = {}, BrakeSteerConfig c = {}, mocks::SimPoseOptions o = {})
      : vehicle(p), camera(vehicle, o, 7), steer(c) {}

  void begin(std::vector<SteerStep> steps, std::optional<double> heading = {}) {
    ASSERT_TRUE(steer.begin(steps, heading, now));
  }
  void tick() {
    vehicle.update(now);
    SteerInput input;
    if (const auto sample = camera.poll(now); sample && *sample) input.pose = *sample;
    input.yaw_rate_rad_s = vehicle.state().yaw_rate_rad_s;
    if (renews) steer.renew(now + 100ms);
    output = steer.update(input, now);
    vehicle.command({output.thrust, output.pitch_rad, output.brakes.left, output.brakes.right});
    now += 10ms;
  }
  void run(double seconds) {
    for (const Instant end = now + hal::from_seconds(seconds); now < end && !steer.done();) tick();
  }
  // Until it moves.
  void set_off() {
    for (int i = 0; i < 2000 && vehicle.speed_m_s() < 0.25; ++i) tick();
    ASSERT_GE(vehicle.speed_m_s(), 0.25);
  }
  [[nodiscard]] double error(double x, double y) const {
    const hal::Vec3 at = vehicle.state().pose.position;
    return std::hypot(at.x - x, at.y - y);
  }
  [[nodiscard]] bool locked() const { return output.brakes.left == 1.0 && output.brakes.right == 1.0; }

  mocks::RollingVehicle vehicle;
  mocks::SimPoseSource camera;
  BrakeSteer steer;
  SteerOutput output;
  Instant now{};
  bool renews = true;
};

TEST(BrakeSteer, LocksBothBrakesUntilItIsToldToMove) {
  Rig rig;
  rig.run(2.0);
  EXPECT_TRUE(rig.locked());
  EXPECT_EQ(rig.output.thrust, 0.0);
  EXPECT_EQ(rig.vehicle.state().pose.position.x, 0.0);
}

TEST(BrakeSteer, RefusesStepsThatLeadNowhere) {
  Rig rig;
  EXPECT_FALSE(rig.steer.begin({}, {}, rig.now));
  const std::vector<SteerStep> lost{{1.0, std::numeric_limits<double>::quiet_NaN()}};
  EXPECT_FALSE(rig.steer.begin(lost, {}, rig.now));
  const std::vector<SteerStep> fine{{1.0, 0.0}};
  EXPECT_FALSE(rig.steer.begin(fine, std::numeric_limits<double>::infinity(), rig.now));
}

TEST(BrakeSteer, RollsToAStepAheadAndStopsThere) {
  Rig rig;
  rig.begin({{0.6, 0.0}});
  rig.run(30.0);
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived);
  EXPECT_LT(rig.error(0.6, 0.0), 0.1);
  EXPECT_EQ(rig.steer.stats().turns, 0U);
}

TEST(BrakeSteer, TurnsToBothSides) {
  for (const double side : {1.0, -1.0}) {
    Rig rig;
    rig.begin({{1.0, 0.6 * side}});
    rig.run(40.0);
    EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived) << side;
    EXPECT_LT(rig.error(1.0, 0.6 * side), 0.15) << side;
    EXPECT_GE(rig.steer.stats().turns, 1U);
  }
}

TEST(BrakeSteer, BringsItsHeadingInOrderAtTheGoal) {
  Rig rig;
  rig.begin({{0.6, 0.0}, {1.2, 0.0}}, hal::deg_to_rad(9.0));
  rig.run(40.0);
  ASSERT_EQ(rig.steer.phase(), SteerPhase::arrived);
  EXPECT_NEAR(hal::rad_to_deg(rig.vehicle.state().pose.yaw_rad), 9.0, 7.0);
}

TEST(BrakeSteer, LearnsHowThisVehicleCoastsAndStops) {
  mocks::RollingParameters p;
  p.rolling_resistance = 0.012;
  p.surface_drag_n_s_m = 0.1;
  p.servo_lag_s = 0.03;
  Rig rig(p);
  rig.begin({{0.7, 0.0}, {1.4, 0.4}, {2.1, 0.4}, {2.8, 0.0}, {3.5, 0.0}});
  rig.run(120.0);
  ASSERT_EQ(rig.steer.phase(), SteerPhase::arrived);
  EXPECT_LT(rig.steer.learnt().coast_m_s2, 0.8 * SteerLearnt{}.coast_m_s2) << "half the drag it was told";
  EXPECT_LT(rig.steer.learnt().stop_lag_s, 0.9 * SteerLearnt{}.stop_lag_s) << "a quick servo";
}

TEST(BrakeSteer, HoldsItsLineAgainstAWheelThatDrags) {
  mocks::RollingParameters p;
  p.drag_asymmetry = 0.3;
  p.rolling_resistance = 0.04;
  Rig touching(p);
  touching.begin({{0.75, 0.0}, {1.5, 0.0}, {2.25, 0.0}, {3.0, 0.0}});
  touching.run(120.0);
  EXPECT_EQ(touching.steer.phase(), SteerPhase::arrived);
  EXPECT_LT(touching.error(3.0, 0.0), 0.15);
  EXPECT_GT(touching.steer.stats().dabs, 0U);
}

TEST(BrakeSteer, StopsWhenTheMissionsCommandRunsOutAndGoesOnWhenItReturns) {
  Rig rig;
  rig.begin({{2.0, 0.0}});
  rig.set_off();
  rig.renews = false;
  rig.run(0.12);
  EXPECT_TRUE(rig.locked());
  EXPECT_EQ(rig.output.thrust, 0.0);
  rig.run(1.5);
  EXPECT_LT(std::abs(rig.vehicle.speed_m_s()), 1e-9) << "braked to a stand";
  EXPECT_EQ(rig.steer.phase(), SteerPhase::holding);
  rig.renews = true;
  rig.run(60.0);
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived) << "the geometry was kept";
}

TEST(BrakeSteer, StopsWhenThePoseGrowsOldAndFailsWhenItStaysAway) {
  Rig rig;
  rig.begin({{2.0, 0.0}});
  rig.set_off();
  rig.camera.set_fault(mocks::PoseFault::stall);
  rig.run(0.3);
  EXPECT_TRUE(rig.locked());
  EXPECT_EQ(rig.output.thrust, 0.0);
  rig.run(4.0);
  EXPECT_EQ(rig.steer.fault(), SteerFault::pose_lost);
}

TEST(BrakeSteer, RidesThroughAShortDropout) {
  Rig rig;
  rig.begin({{2.0, 0.0}});
  rig.set_off();
  rig.camera.set_fault(mocks::PoseFault::lost);
  rig.run(0.15);
  EXPECT_EQ(rig.steer.stats().holds, 0U);
  rig.camera.set_fault(mocks::PoseFault::none);
  rig.run(60.0);
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived);
}

TEST(BrakeSteer, PlansAnewWhenTheCameraMovesItsFrame) {
  Rig rig;
  rig.begin({{2.0, 0.0}});
  rig.set_off();
  rig.camera.jump({0.0, 0.4, 0.0}, 0.0, true);
  rig.run(0.1);
  EXPECT_TRUE(rig.locked());
  rig.run(90.0);
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived);
  EXPECT_LT(rig.error(2.0, -0.4), 0.15) << "the goal is where the camera says, 0.4 m to the right of before";
}

TEST(BrakeSteer, SaysSoWhenTheMotorsDoNotPush) {
  Rig rig;
  rig.vehicle.set_thrust_fault(0.0, 0.0);
  rig.begin({{2.0, 0.0}});
  rig.run(10.0);
  EXPECT_EQ(rig.steer.fault(), SteerFault::no_motion);
  EXPECT_TRUE(rig.locked());
}

TEST(BrakeSteer, SaysSoWhenLockedBrakesDoNotHold) {
  mocks::RollingParameters p;
  p.grade_x = -0.06;  // downhill
  Rig rig(p);
  rig.begin({{3.0, 0.0}});
  rig.set_off();
  rig.vehicle.left_brake().set_fault(mocks::BrakeFault::stuck_open);
  rig.vehicle.right_brake().set_fault(mocks::BrakeFault::stuck_open);
  rig.run(60.0);
  EXPECT_EQ(rig.steer.fault(), SteerFault::runs_away);
  EXPECT_EQ(rig.output.thrust, 0.0);
}

TEST(BrakeSteer, SpeedByPitchKeepsThrustAndArrivesAsWell) {
  BrakeSteerConfig config;
  config.speed_by_pitch = true;
  Rig rig({}, config);
  rig.begin({{0.7, 0.0}, {1.3, 0.4}, {2.0, 0.6}});
  double fastest = 0.0;
  bool varied = false;
  while (!rig.steer.done() && rig.now < Instant{120s}) {
    rig.tick();
    fastest = std::max(fastest, rig.vehicle.speed_m_s());
    if (rig.steer.phase() == SteerPhase::driving && !rig.steer.done()) {
      EXPECT_EQ(rig.output.thrust, config.thrust);
      varied = varied || (rig.output.pitch_rad > 0.02 && rig.output.pitch_rad < 0.9 * config.pitch_rad);
    }
  }
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived);
  EXPECT_LT(rig.error(2.0, 0.6), 0.15);
  EXPECT_TRUE(varied) << "the pitch sets the speed";
  EXPECT_LT(fastest, config.max_speed_m_s + 0.1);
}

TEST(BrakeSteer, CallsNoAllocator) {
  Rig rig;
  rig.begin({{0.7, 0.0}, {1.3, 0.4}, {2.0, 0.6}});
  rig.run(1.0);
  const std::uint64_t before = test::allocation_count();
  while (!rig.steer.done() && rig.now < Instant{120s}) rig.tick();
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(rig.steer.phase(), SteerPhase::arrived);
}

TEST(BrakeSteer, EveryOutputRunsOutByItself) {
  Rig rig;
  rig.begin({{2.0, 0.0}});
  for (int i = 0; i < 300; ++i) {
    const Instant at = rig.now;
    rig.tick();
    EXPECT_GT(rig.output.brakes.valid_until, at);
    EXPECT_LE(rig.output.brakes.valid_until, at + 150ms);
  }
}

}  // namespace
}  // namespace forager::servo
