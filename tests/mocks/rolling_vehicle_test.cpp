#include "mocks/rolling_vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

constexpr RollingCommand kOpen{.thrust = 0.0, .pitch_rad = 0.0, .brake_left = 0.0, .brake_right = 0.0};

// Nothing but what a test switches on.
RollingParameters bare() {
  RollingParameters p;
  p.rolling_resistance = p.surface_drag_n_s_m = p.scrub_torque_n_m = 0.0;
  p.thrust_lag_s = p.pitch_lag_s = p.servo_lag_s = 1e-6;
  p.servo_dead_s = 0.0;
  p.servo_slew_1_s = 1e6;
  return p;
}

void run(RollingVehicle& vehicle, double seconds) {
  const auto steps = std::lround(seconds / hal::to_seconds(vehicle.parameters().step));
  for (long i = 0; i < steps; ++i) vehicle.step();
}

double run_until_still(RollingVehicle& vehicle, double most_s = 60.0) {
  double t = 0.0;
  while (t < most_s &&
         (std::abs(vehicle.speed_m_s()) > 1e-9 || std::abs(vehicle.state().yaw_rate_rad_s) > 1e-9)) {
    vehicle.step();
    t += hal::to_seconds(vehicle.parameters().step);
  }
  return t;
}

TEST(RollingVehicle, StandsWithBothBrakesLockedWhateverTheMotorsDo) {
  RollingVehicle vehicle{RollingParameters{}};
  vehicle.command({.thrust = 0.3, .pitch_rad = hal::deg_to_rad(30.0)});
  run(vehicle, 10.0);
  EXPECT_EQ(vehicle.state().pose.position.x, 0.0);
  EXPECT_EQ(vehicle.state().pose.yaw_rad, 0.0);
  EXPECT_EQ(vehicle.left_wheel(), WheelState::held);
}

TEST(RollingVehicle, CoastsAsFarAsRollingResistanceLetsIt) {
  RollingParameters p = bare();
  p.rolling_resistance = 0.03;
  RollingVehicle vehicle{p};
  vehicle.command(kOpen);
  run(vehicle, 0.1);  // brakes open
  vehicle.set_motion(0.8, 0.0);
  const double from = vehicle.state().pose.position.x;
  run_until_still(vehicle);
  const double expected = 0.8 * 0.8 / (2.0 * 0.03 * p.gravity_m_s2);
  EXPECT_NEAR(vehicle.state().pose.position.x - from, expected, 1e-3 * expected);
  EXPECT_NEAR(vehicle.state().pose.position.y, 0.0, 1e-12);
}

TEST(RollingVehicle, AcceleratesByTheForwardShareOfThrustAndLightensTheWheels) {
  RollingParameters p = bare();
  p.rolling_resistance = 0.02;
  RollingVehicle vehicle{p};
  const double pitch = hal::deg_to_rad(25.0);
  RollingCommand command = kOpen;
  command.thrust = 0.2;
  command.pitch_rad = pitch;
  vehicle.command(command);
  run(vehicle, 0.1);
  const double v0 = vehicle.speed_m_s();
  run(vehicle, 1.0);
  const double thrust = 0.2 * p.max_thrust_n;
  const double normal = p.mass_kg * p.gravity_m_s2 - thrust * std::cos(pitch);
  EXPECT_NEAR(vehicle.normal_n(), normal, 1e-6);
  EXPECT_NEAR(vehicle.speed_m_s() - v0, (thrust * std::sin(pitch) - 0.02 * normal) / p.mass_kg, 1e-6);
}

TEST(RollingVehicle, ReachesTheSpeedAtWhichSurfaceDragEatsTheDrive) {
  RollingParameters p = bare();
  p.rolling_resistance = 0.02;
  p.surface_drag_n_s_m = 2.0;
  RollingVehicle vehicle{p};
  RollingCommand command = kOpen;
  command.thrust = 0.2;
  command.pitch_rad = hal::deg_to_rad(20.0);
  vehicle.command(command);
  run(vehicle, 40.0);
  EXPECT_NEAR(vehicle.speed_m_s(), (vehicle.drive_force_n() - 0.02 * vehicle.normal_n()) / 2.0, 1e-6);
}

TEST(RollingVehicle, PivotsAboutTheLockedWheelWithTheInertiaAboutThatWheel) {
  const RollingParameters p = bare();
  RollingVehicle vehicle{p};
  RollingCommand command = kOpen;
  command.brake_left = 1.0;
  command.thrust = 0.05;
  command.pitch_rad = hal::deg_to_rad(30.0);
  vehicle.command(command);
  run(vehicle, 1.0);
  const double drive = 0.05 * p.max_thrust_n * std::sin(hal::deg_to_rad(30.0));
  const double about_wheel = p.yaw_inertia_kg_m2 + p.mass_kg * p.half_track_m * p.half_track_m;
  EXPECT_NEAR(vehicle.state().yaw_rate_rad_s, drive * p.half_track_m / about_wheel, 1e-3);
  EXPECT_GT(vehicle.state().pose.yaw_rad, 0.0) << "the left brake turns it to the left";
  // The locked wheel has not moved: the middle of the axle is on a circle of half the track about it.
  const hal::Vec3 at = vehicle.state().pose.position;
  EXPECT_NEAR(std::hypot(at.x, at.y - p.half_track_m), p.half_track_m, 1e-5);
  EXPECT_EQ(vehicle.left_wheel(), WheelState::held);
}

TEST(RollingVehicle, ALockedWheelSlipsWhereTheFloorDoesNotHoldIt) {
  RollingParameters p = bare();
  p.friction = 0.1;
  RollingVehicle vehicle{p};
  vehicle.set_motion(1.0, 0.0);
  vehicle.command({});
  vehicle.step();
  EXPECT_EQ(vehicle.left_wheel(), WheelState::sliding);
  run_until_still(vehicle);
  const double grip = 0.1 * (1.0 - p.front_load_share) * p.gravity_m_s2;
  EXPECT_NEAR(vehicle.state().pose.position.x, 1.0 / (2.0 * grip), 0.01);
}

TEST(RollingVehicle, MoreThrustMeansLessGrip) {
  const auto way = [](double thrust) {
    RollingParameters p = bare();
    p.friction = 0.2;
    RollingVehicle vehicle{p};
    RollingCommand command;
    command.thrust = thrust;  // straight up: no drive, only less weight
    vehicle.command(command);
    run(vehicle, 0.1);
    vehicle.set_motion(1.0, 0.0);
    run_until_still(vehicle);
    return vehicle.state().pose.position.x;
  };
  EXPECT_GT(way(0.3), 1.5 * way(0.0));
}

TEST(RollingVehicle, SaysWhenThrustTakesTheWeightOff) {
  RollingVehicle vehicle{bare()};
  RollingCommand command;
  command.thrust = 0.9;
  vehicle.command(command);
  run(vehicle, 0.1);
  EXPECT_TRUE(vehicle.lifts());
  EXPECT_GE(vehicle.normal_n(), 0.0);
}

TEST(RollingVehicle, OneSidedDragBendsItsWay) {
  RollingParameters p = bare();
  p.rolling_resistance = 0.03;
  p.drag_asymmetry = 0.3;
  RollingVehicle vehicle{p};
  vehicle.command(kOpen);
  run(vehicle, 0.1);
  vehicle.set_motion(0.5, 0.0);
  run(vehicle, 0.3);
  EXPECT_GT(vehicle.state().pose.yaw_rad, 0.01) << "the left wheel drags more: it turns left";
}

TEST(RollingVehicle, StaysOnASlopeWhileBrakedAndRollsDownWhenReleased) {
  RollingParameters p = bare();
  p.rolling_resistance = 0.01;
  p.grade_x = 0.05;
  RollingVehicle vehicle{p};
  vehicle.command({});
  run(vehicle, 5.0);
  EXPECT_EQ(vehicle.state().pose.position.x, 0.0);
  vehicle.command(kOpen);
  run(vehicle, 1.0);
  EXPECT_LT(vehicle.speed_m_s(), -0.3);
}

TEST(RollingVehicle, KeepsItsBooksOfEnergy) {
  RollingParameters p;
  p.grade_x = 0.01;
  p.grade_y = -0.02;
  p.drag_asymmetry = 0.1;
  p.thrust_offset_m = 0.01;
  RollingVehicle vehicle{p};
  const RollingCommand commands[] = {
      {.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 1.0, .brake_right = 0.0},
      {.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 0.0, .brake_right = 0.0},
      {.thrust = 0.0, .pitch_rad = 0.4, .brake_left = 0.0, .brake_right = 0.0},
      {.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 0.0, .brake_right = 0.6},
      {}};
  for (const RollingCommand& command : commands) {
    vehicle.command(command);
    run(vehicle, 1.0);
    const RollingEnergy& book = vehicle.energy();
    EXPECT_NEAR(book.put_in, book.climbed + book.taken() + vehicle.kinetic_j(), 1e-6 + 1e-3 * book.put_in);
    for (const double taken : {book.brakes, book.rolling, book.surface, book.scrub}) EXPECT_GE(taken, -1e-9);
  }
  EXPECT_GT(vehicle.energy().put_in, 0.5);
}

TEST(RollingVehicle, HalvingTheStepHardlyMovesIt) {
  const auto drive = [](hal::Duration step) {
    RollingParameters p;
    p.step = step;
    RollingVehicle vehicle{p};
    vehicle.command({.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 1.0, .brake_right = 0.0});
    run(vehicle, 1.2);
    vehicle.command({.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 0.0, .brake_right = 0.0});
    run(vehicle, 1.0);
    vehicle.command({});
    run(vehicle, 2.0);
    return vehicle.state().pose;
  };
  const hal::Pose coarse = drive(2ms);
  const hal::Pose fine = drive(250us);
  EXPECT_LT(norm(coarse.position - fine.position), 6e-3);
  EXPECT_NEAR(coarse.yaw_rad, fine.yaw_rad, 1e-2);
}

TEST(RollingVehicle, DoesNotCareHowUpdatesAreSpaced) {
  const auto drive = [](hal::Duration spacing) {
    RollingVehicle vehicle{RollingParameters{}};
    vehicle.command({.thrust = 0.15, .pitch_rad = 0.4, .brake_left = 0.0, .brake_right = 1.0});
    for (Instant now{}; now <= Instant{2s}; now += spacing) vehicle.update(now);
    return vehicle.state().pose;
  };
  EXPECT_EQ(drive(10ms), drive(250ms));
}

TEST(RollingVehicle, BrokenBrakesDoWhatTheyAreBrokenTo) {
  RollingVehicle vehicle{RollingParameters{}};
  vehicle.right_brake().set_fault(BrakeFault::stuck_open);
  vehicle.set_motion(0.6, 0.0);
  vehicle.command({});
  run(vehicle, 0.5);
  EXPECT_EQ(vehicle.right_brake_n(), 0.0);
  EXPECT_GT(vehicle.state().pose.yaw_rad, 0.1) << "one brake alone turns it";
  vehicle.right_brake().set_fault(BrakeFault::stuck_locked);
  vehicle.command(kOpen);
  run(vehicle, 0.5);
  EXPECT_GT(vehicle.right_brake_n(), 0.9 * vehicle.parameters().brake_force_n);
}

TEST(RollingVehicle, DeadMotorsDrawItToTheSide) {
  RollingVehicle vehicle{RollingParameters{}};
  vehicle.set_thrust_fault(0.75, 0.07);
  RollingCommand command = kOpen;
  command.thrust = 0.15;
  command.pitch_rad = 0.4;
  vehicle.command(command);
  run(vehicle, 1.0);
  EXPECT_LT(vehicle.state().pose.yaw_rad, -0.05);
  vehicle.set_thrust_fault(0.0, 0.0);
  run(vehicle, 1.0);
  EXPECT_NEAR(vehicle.drive_force_n(), 0.0, 1e-3);
}

}  // namespace
}  // namespace forager::mocks
