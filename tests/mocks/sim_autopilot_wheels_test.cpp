#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/units.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "tests/mocks/autopilot_client.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

SimAutopilotConfig on_wheels() {
  SimAutopilotConfig config;
  config.step = 10ms;
  config.guided_thrust = true;
  config.guided_timeout = 300ms;
  config.origin_known = true;
  config.mode = peer::CopterMode::guided;
  return config;
}

struct Attitude {
  double pitch_rad = hal::deg_to_rad(20.0);  // nose down
  double thrust = 0.15;
  std::uint8_t mask = 0x07;
  double length = 1.0;  // of the quaternion
};

MavlinkPayload encode(const Attitude& a) {
  MavlinkPayload p;
  p.f32(4, a.length * std::cos(0.5 * a.pitch_rad));
  p.f32(12, a.length * -std::sin(0.5 * a.pitch_rad));  // nose up is positive there
  p.f32(32, a.thrust);
  p.put(36, std::uint8_t{1});
  p.put(37, std::uint8_t{1});
  p.put(38, a.mask);
  return p;
}

struct Wheels {
  explicit Wheels(SimAutopilotConfig config = on_wheels()) : bench(config), vehicle(RollingParameters{}) {
    bench.sim().put_on_wheels(&vehicle);
    vehicle.press(0.0, 0.0);
    bench.run(2s);
  }
  void arm() { ASSERT_EQ(bench.command(peer::kComponentArmDisarm, {1.0}), peer::Result::accepted); }
  void drive(hal::Duration length, const Attitude& a) {
    bench.run(length, [&] { bench.send(peer::kSetAttitudeTarget, encode(a)); });
  }
  AutopilotBench bench;
  RollingVehicle vehicle;
};

TEST(SimAutopilotOnWheels, AttitudeAndThrustPushItForward) {
  Wheels wheels;
  wheels.arm();
  wheels.drive(1s, {});
  EXPECT_GT(wheels.vehicle.speed_m_s(), 0.2);
  EXPECT_NEAR(wheels.vehicle.drive_force_n(),
              0.15 * wheels.vehicle.parameters().max_thrust_n * std::sin(hal::deg_to_rad(20.0)), 0.1);
  EXPECT_EQ(&wheels.bench.sim().state(), &wheels.vehicle.state()) << "its truth is the vehicle's";
}

TEST(SimAutopilotOnWheels, DoesNothingUnarmedOrOutsideGuided) {
  Wheels unarmed;
  unarmed.drive(1s, {});
  EXPECT_EQ(unarmed.vehicle.speed_m_s(), 0.0);
  Wheels wheels;
  wheels.arm();
  ASSERT_TRUE(wheels.bench.sim().set_mode(peer::CopterMode::stabilize));
  wheels.drive(1s, {});
  EXPECT_EQ(wheels.vehicle.thrust_n(), 0.0);
}

TEST(SimAutopilotOnWheels, IgnoresWhatArduCopterIgnores) {
  const Attitude useless[] = {
      {.mask = 0x47},    // throttle ignored
      {.mask = 0x87},    // attitude ignored
      {.mask = 0x03},    // some rates
      {.length = 1.01},  // no unit quaternion
      {.thrust = std::numeric_limits<double>::quiet_NaN()},
  };
  Wheels wheels;
  wheels.arm();
  for (const Attitude& a : useless) {
    wheels.drive(200ms, a);
    EXPECT_EQ(wheels.vehicle.speed_m_s(), 0.0);
  }
  EXPECT_GT(wheels.bench.sim().setpoints_ignored(), 0U);
  EXPECT_EQ(wheels.bench.sim().setpoints_taken(), 0U);
}

TEST(SimAutopilotOnWheels, LevelsWhenTheStreamStopsAndKeepsItsThrust) {
  Wheels wheels;
  wheels.arm();
  wheels.drive(1s, {});
  wheels.bench.run(1500ms);
  EXPECT_NEAR(wheels.vehicle.drive_force_n(), 0.0, 0.05);
  EXPECT_GT(wheels.vehicle.thrust_n(), 5.0);
}

TEST(SimAutopilotOnWheels, ThrustIsAClimbRateUnlessTheOptionSaysOtherwise) {
  SimAutopilotConfig config = on_wheels();
  config.guided_thrust = false;
  Wheels wheels(config);
  wheels.arm();
  wheels.drive(1s, {});
  EXPECT_EQ(wheels.vehicle.thrust_n(), 0.0);
}

TEST(SimAutopilotOnWheels, DisarmsByForceWhilePushed) {
  Wheels wheels;
  wheels.arm();
  wheels.drive(1s, {});
  EXPECT_EQ(wheels.bench.command(peer::kComponentArmDisarm, {0.0}), peer::Result::failed)
      << "not landed, says the land detector";
  EXPECT_EQ(wheels.bench.command(peer::kComponentArmDisarm, {0.0, 21196.0}), peer::Result::accepted);
  wheels.bench.run(1s);
  EXPECT_LT(wheels.vehicle.thrust_n(), 0.01);
}

}  // namespace
}  // namespace forager::mocks
