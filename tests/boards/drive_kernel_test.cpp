// The drive loop on the real PWM backend: brake pulses go through sysfs to the emulated servos.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "boards/drive_direct.hpp"
#include "boards/drive_run.hpp"
#include "flight/drive_loop.hpp"
#include "hal/linux/sysfs_pwm.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"
#include "mocks/virtual_clock.hpp"
#include "servo/pwm_brake.hpp"
#include "tests/hal/linux/fake_kernel.hpp"
#include "tests/hal/linux/fake_pwm_chip.hpp"
#include "tests/places.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

// Where a servo stands for what the kernel's file says.
double place(hal::fake::FakePwmChip& chip, std::size_t line, double pressed_us) {
  if (!chip.line(line).enabled) return 1.0;
  const double us = static_cast<double>(chip.line(line).duty) * 1e-3;
  return std::clamp((us - 1180.0) / (pressed_us - 1180.0), 0.0, 1.0);
}

TEST(DriveOverSysfs, ReachesTheGoalAndLeavesTheBrakesLockedInTheKernel) {
  const auto scene = load_drive_scene(test::source_path("scenes/course.toml"));
  ASSERT_TRUE(scene);
  hal::fake::FakeKernel kernel;
  mocks::VirtualClock clock{Instant{}};
  hal::fake::FakePwmChip chip{kernel, clock, "pwmchip0", 2};
  const auto pwm = hal::open_sysfs_pwm({.channels = {0, 1}}, clock, kernel);
  ASSERT_TRUE(pwm) << hal::describe(pwm.error());
  auto left = servo::PwmBrake::create((*pwm)->channel(0), servo::laboratory_left());
  auto right = servo::PwmBrake::create((*pwm)->channel(1), servo::laboratory_right());
  ASSERT_TRUE(left && right);

  const DrivePlantDraw draw = draw_plant(*scene, 5);
  mocks::RollingVehicle vehicle(draw.vehicle, scene->start);
  mocks::SimPoseSource camera(vehicle, draw.pose, 11);
  DirectAutopilot autopilot(vehicle, *scene, draw, 12);
  hal::NullJournal journal;
  Instant now = clock.now();
  flight::DriveLoop loop(scene->drive, {autopilot, camera, *left, *right, journal},
                         drive_mission(*scene).value(), now);
  for (; !loop.done() && now < Instant{200s}; now += 10ms) {
    autopilot.run(now);
    vehicle.push(autopilot.thrust(), autopilot.pitch_rad());
    vehicle.press(place(chip, 0, 1725.0), place(chip, 1, 1875.0));
    vehicle.update(now);
    loop.feed(now);
    loop.go(now + 100ms);
    loop.update(now);
  }
  EXPECT_EQ(loop.status().end, flight::DriveEnd::arrived) << loop.status().detail;
  const servo::PathPose goal = scene->path.back();
  EXPECT_LT(
      std::hypot(vehicle.state().pose.position.x - goal.x_m, vehicle.state().pose.position.y - goal.y_m),
      0.15);
  EXPECT_EQ(chip.line(0).duty, 1725000);
  EXPECT_EQ(chip.line(1).duty, 1875000);

  // Halted under way it locks both in the kernel at once.
  loop.halt();
  EXPECT_TRUE(chip.line(0).enabled);
  EXPECT_EQ(chip.line(0).duty, 1725000);
}

}  // namespace
}  // namespace forager::boards
