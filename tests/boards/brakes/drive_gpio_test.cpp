// The drive loop on the real GPIO backend: spring-applied brakes on two lines of the kernel, opened by
// current.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "boards/drive_direct.hpp"
#include "boards/drive_run.hpp"
#include "flight/drive_loop.hpp"
#include "hal/linux/gpio.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"
#include "servo/digital_brake.hpp"
#include "tests/hal/linux/fake_gpio_kernel.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using hal::Instant;
using hal::fake::FakeGpio;

TEST(DriveOverGpio, ReachesTheGoalAndLeavesBothLinesWithoutCurrent) {
  FakeGpio::get().reset();
  FakeGpio::get().chips[0] = {.label = "pinctrl-bcm2711",
                              .lines = {{.name = "BRAKE_LEFT"}, {.name = "BRAKE_RIGHT"}, {.name = "STOP"}}};
  const auto level = [](std::size_t line) { return FakeGpio::get().chips.at(0).lines.at(line).level; };
  auto scene = load_drive_scene(FORAGER_SOURCE_DIR "/scenes/course.toml");
  ASSERT_TRUE(scene);
  // A solenoid is all or nothing, and quick.
  scene->ranges[static_cast<std::size_t>(DriveRange::servo_lag_s)] = {0.02, 0.02};
  {
    const auto left_line = hal::open_gpio_out({.chip = "pinctrl-bcm2711", .line = "BRAKE_LEFT"});
    const auto right_line = hal::open_gpio_out({.chip = "pinctrl-bcm2711", .line = "BRAKE_RIGHT"});
    const auto stop = hal::open_gpio_in({.chip = "pinctrl-bcm2711", .line = "STOP"});
    ASSERT_TRUE(left_line && right_line && stop);
    servo::DigitalBrake left(**left_line, servo::WhenActive::opens);
    servo::DigitalBrake right(**right_line, servo::WhenActive::opens);

    const DrivePlantDraw draw = draw_plant(*scene, 3);
    mocks::RollingVehicle vehicle(draw.vehicle, scene->start);
    mocks::SimPoseSource camera(vehicle, draw.pose, 21);
    DirectAutopilot autopilot(vehicle, *scene, draw, 22);
    hal::NullJournal journal;
    Instant now{};
    flight::DriveLoop loop(scene->drive, {autopilot, camera, left, right, journal, nullptr, stop->get()},
                           drive_mission(*scene).value(), now);
    bool opened = false;
    for (; !loop.done() && now < Instant{250s}; now += 10ms) {
      autopilot.run(now);
      vehicle.push(autopilot.thrust(), autopilot.pitch_rad());
      vehicle.press(level(0) ? 0.0 : 1.0, level(1) ? 0.0 : 1.0);
      vehicle.update(now);
      opened = opened || (level(0) && level(1));
      loop.feed(now);
      loop.go(now + 100ms);
      loop.update(now);
    }
    EXPECT_TRUE(opened);
    EXPECT_EQ(loop.status().end, flight::DriveEnd::arrived) << loop.status().detail;
    const servo::PathPose goal = scene->path.back();
    const hal::Vec3 at = vehicle.state().pose.position;
    EXPECT_LT(std::hypot(at.x - goal.x_m, at.y - goal.y_m), 0.15);
    EXPECT_FALSE(level(0) || level(1)) << "springs hold both";
  }
  EXPECT_EQ(FakeGpio::get().open_handles(), 0U);
}

// The button is a line of the kernel too.
TEST(DriveOverGpio, TheStopButtonEndsItInTheSameUpdate) {
  FakeGpio::get().reset();
  FakeGpio::get().chips[0] = {.label = "pinctrl-bcm2711",
                              .lines = {{.name = "BRAKE_LEFT"}, {.name = "BRAKE_RIGHT"}, {.name = "STOP"}}};
  const auto scene = load_drive_scene(FORAGER_SOURCE_DIR "/scenes/course.toml");
  ASSERT_TRUE(scene);
  {
    const auto left_line = hal::open_gpio_out({.chip = "pinctrl-bcm2711", .line = "BRAKE_LEFT"});
    const auto right_line = hal::open_gpio_out({.chip = "pinctrl-bcm2711", .line = "BRAKE_RIGHT"});
    const auto stop = hal::open_gpio_in({.chip = "pinctrl-bcm2711", .line = "STOP"});
    ASSERT_TRUE(left_line && right_line && stop);
    servo::DigitalBrake left(**left_line, servo::WhenActive::opens);
    servo::DigitalBrake right(**right_line, servo::WhenActive::opens);
    const DrivePlantDraw draw = draw_plant(*scene, 3);
    mocks::RollingVehicle vehicle(draw.vehicle, scene->start);
    mocks::SimPoseSource camera(vehicle, draw.pose, 21);
    DirectAutopilot autopilot(vehicle, *scene, draw, 22);
    hal::NullJournal journal;
    Instant now{};
    flight::DriveLoop loop(scene->drive, {autopilot, camera, left, right, journal, nullptr, stop->get()},
                           drive_mission(*scene).value(), now);
    auto& lines = FakeGpio::get().chips.at(0).lines;
    while (!(lines[0].level && lines[1].level) && now < Instant{30s}) {
      autopilot.run(now);
      vehicle.update(now);
      loop.feed(now);
      loop.go(now + 100ms);
      loop.update(now);
      now += 10ms;
    }
    ASSERT_TRUE(lines[0].level && lines[1].level);
    lines[2].level = true;
    loop.feed(now);
    loop.update(now);
    EXPECT_EQ(loop.status().end, flight::DriveEnd::emergency_stop);
    EXPECT_FALSE(lines[0].level || lines[1].level);
  }
}

}  // namespace
}  // namespace forager::boards
