#include "mocks/vehicle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Vec3;

struct Extremes {
  double speed = 0.0, climb = 0.0, descent = 0.0, across = 0.0, upward = 0.0, yaw_rate = 0.0, yaw_push = 0.0;
  Vec3 least{1e9, 1e9, 1e9}, most{-1e9, -1e9, -1e9};
};

class Flight {
 public:
  explicit Flight(VehicleParameters p = {}, hal::Pose start = {{0, 0, 1.5}}) : vehicle(p, start) {
    command.motors = true;
    command.yaw_by_rate = false;
    command.horizontal = command.vertical = VehicleCommand::Follow::position;
    command.position_world = start.position;
  }
  Extremes run(hal::Duration length, hal::Duration dt = 20ms) {
    Extremes e;
    for (const hal::Instant end = now + length; now < end;) {
      now += dt;
      vehicle.command(command);
      const double yaw_rate = vehicle.state().yaw_rate_rad_s;
      vehicle.update(dt, now);
      const BodyState& s = vehicle.state();
      const Vec3 a = vehicle.acceleration_world_m_s2();
      e.speed = std::max(e.speed, std::hypot(s.velocity_world_m_s.x, s.velocity_world_m_s.y));
      e.climb = std::max(e.climb, s.velocity_world_m_s.z);
      e.descent = std::max(e.descent, -s.velocity_world_m_s.z);
      e.across = std::max(e.across, std::hypot(a.x, a.y));
      e.upward = std::max(e.upward, std::abs(a.z));
      e.yaw_rate = std::max(e.yaw_rate, std::abs(s.yaw_rate_rad_s));
      e.yaw_push = std::max(e.yaw_push, std::abs(s.yaw_rate_rad_s - yaw_rate) / hal::to_seconds(dt));
      const Vec3 p = s.pose.position;
      e.least = {std::min(e.least.x, p.x), std::min(e.least.y, p.y), std::min(e.least.z, p.z)};
      e.most = {std::max(e.most.x, p.x), std::max(e.most.y, p.y), std::max(e.most.z, p.z)};
    }
    return e;
  }
  Vehicle vehicle;
  VehicleCommand command;
  hal::Instant now;
};

TEST(Vehicle, NeverExceedsItsLimitsWhateverIsAsked) {
  const VehicleParameters p;
  hal::Random random(11);
  Flight flight(p, {{0, 0, 30}});
  for (int i = 0; i < 300; ++i) {
    VehicleCommand& c = flight.command;
    c.horizontal = random.chance(0.5) ? VehicleCommand::Follow::position : VehicleCommand::Follow::velocity;
    c.vertical = random.chance(0.5) ? VehicleCommand::Follow::position : VehicleCommand::Follow::velocity;
    c.position_world = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(20, 40)};
    c.velocity_world_m_s = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    if (flight.vehicle.state().pose.position.z < 15) c.velocity_world_m_s.z = 1.0;
    c.yaw_by_rate = random.chance(0.5);
    c.yaw_rad = random.uniform(-3, 3);
    c.yaw_rate_rad_s = random.uniform(-3, 3);
    const Extremes e = flight.run(std::chrono::milliseconds(20 * (1 + random.below(100))));
    constexpr double kSlack = 1.02;  // the loops end exponentially
    EXPECT_LE(e.speed, kSlack * p.max_speed_m_s);
    EXPECT_LE(e.climb, kSlack * p.max_climb_m_s);
    EXPECT_LE(e.descent, kSlack * p.max_descent_m_s);
    EXPECT_LE(e.across, p.max_acceleration_m_s2 + 1e-9);
    EXPECT_LE(e.upward, p.max_vertical_acceleration_m_s2 + 1e-9);
    EXPECT_LE(e.yaw_rate, p.max_yaw_rate_rad_s + 1e-9);
    EXPECT_LE(e.yaw_push, p.max_yaw_acceleration_rad_s2 + 1e-6);
  }
}

TEST(Vehicle, ArrivesWithoutOvershootAtEveryStepLength) {
  for (const hal::Duration dt : {hal::Duration(5ms), hal::Duration(20ms), hal::Duration(50ms)}) {
    for (const double distance : {0.1, 0.5, 1.0, 8.0}) {
      Flight flight;
      flight.command.position_world = {distance, -0.5 * distance, 1.5};
      flight.command.yaw_rad = 3.0;
      const Extremes e = flight.run(25s, dt);
      EXPECT_LT(e.most.x, distance + 0.01);
      EXPECT_GT(e.least.y, -0.5 * distance - 0.01);
      EXPECT_NEAR(flight.vehicle.state().pose.position.x, distance, 0.005);
      EXPECT_NEAR(flight.vehicle.state().pose.yaw_rad, 3.0, 0.005);
    }
  }
}

TEST(Vehicle, TheStepLengthHardlyMatters) {
  const auto at = [](hal::Duration dt) {
    Flight flight;
    flight.command.position_world = {4, 2, 2.5};
    flight.run(3s, dt);
    return flight.vehicle.state().pose.position;
  };
  EXPECT_LT(hal::norm(at(5ms) - at(20ms)), 0.02);
  EXPECT_LT(hal::norm(at(5ms) - at(50ms)), 0.06);
}

TEST(Vehicle, LeansIntoItsAcceleration) {
  Flight flight;
  flight.command.position_world = {8, 0, 1.5};
  flight.run(400ms);
  const double a = flight.vehicle.acceleration_world_m_s2().x;
  EXPECT_GT(a, 0.8);
  EXPECT_NEAR(flight.vehicle.state().pose.pitch_rad, std::atan(a / 9.80665), 0.02);  // nose down
  EXPECT_NEAR(flight.vehicle.state().pose.roll_rad, 0.0, 1e-6);
  Flight left;
  left.command.position_world = {0, 8, 1.5};
  left.run(400ms);
  EXPECT_LT(left.vehicle.state().pose.roll_rad, -0.08);  // left side down
}

TEST(Vehicle, HoldsItsPlaceInGusts) {
  VehicleParameters p;
  p.wind_gust_m_s = 1.5;
  Flight flight(p);
  const Extremes e = flight.run(120s);
  EXPECT_GT(e.most.x - e.least.x, 1e-3);
  EXPECT_LT(e.most.x - e.least.x, 0.5);
  VehicleParameters other = p;
  other.seed = 2;
  Flight elsewhere(other);
  elsewhere.run(120s);
  EXPECT_NE(elsewhere.vehicle.state().pose.position.x, flight.vehicle.state().pose.position.x);
}

TEST(Vehicle, FallsWithoutMotors) {
  Flight flight({}, {{0, 0, 5}});
  flight.command.motors = false;
  flight.run(500ms);
  EXPECT_NEAR(flight.vehicle.state().pose.position.z, 5.0 - 0.5 * 9.80665 * 0.25, 0.01);
  flight.run(2s);
  EXPECT_TRUE(flight.vehicle.state().on_ground);
  EXPECT_EQ(flight.vehicle.hard_landings(), 1u);
}

TEST(Vehicle, HoversAsLongAsItsEndurance) {
  VehicleParameters p;
  p.endurance_s = 100;
  Flight flight(p);
  flight.run(50s);
  EXPECT_NEAR(flight.vehicle.battery_fraction(), 0.5, 0.01);
  EXPECT_LT(flight.vehicle.battery_v(), 15.4);
  EXPECT_NEAR(flight.vehicle.battery_a(), 360.0, 1e-6);  // 10 Ah in 100 s
  Flight standing(p, {});
  standing.command.motors = false;
  standing.run(50s);
  EXPECT_GT(standing.vehicle.battery_fraction(), 0.96);
}

TEST(Vehicle, EveryApproachToABoxCountsOnce) {
  World world;
  world.obstacles.push_back({{2, -1, 0}, {3, 1, 3}});
  Flight flight;
  flight.vehicle.attach(&world, nullptr);
  flight.command.position_world = {5, 0, 1.5};
  const Extremes e = flight.run(10s);
  EXPECT_EQ(flight.vehicle.collisions(), 1u);
  EXPECT_LE(e.most.x, 2.0 - flight.vehicle.parameters().radius_m);
  flight.command.position_world = {0, 0, 1.5};
  flight.run(5s);
  flight.command.position_world = {5, 0, 1.5};
  flight.run(10s);
  EXPECT_EQ(flight.vehicle.collisions(), 2u);
  flight.command.position_world = {0, 0, 1.5};
  flight.run(5s);
  flight.command.position_world = {0, 0, 4.0};
  flight.run(8s);
  flight.command.position_world = {5, 0, 4.0};  // over it
  flight.run(12s);
  EXPECT_EQ(flight.vehicle.collisions(), 2u);
  EXPECT_NEAR(flight.vehicle.state().pose.position.x, 5.0, 0.01);
}

}  // namespace
}  // namespace forager::mocks
