#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "boards/drive_direct.hpp"
#include "boards/drive_run.hpp"
#include "flight/drive_loop.hpp"
#include "hal/linux/gpio.hpp"
#include "mocks/rolling_vehicle.hpp"
#include "mocks/sim_pose_source.hpp"
#include "servo/digital_brake.hpp"
#include "tests/places.hpp"

// The drive loop on the real GPIO backend, spring-applied brakes on two lines and the stop button on a third:
// as tests for every kernel alike. Include it in one file of a test program and instantiate DriveOverGpio.
namespace forager::boards {

// A chip named kDriveChip with lines BRAKE_LEFT, BRAKE_RIGHT and STOP, seen from the other side.
constexpr const char* kDriveChip = "pinctrl-bcm2711";
class DriveLines {
 public:
  virtual ~DriveLines() = default;
  [[nodiscard]] virtual bool level(unsigned line) = 0;
  virtual void press_stop() = 0;
};
struct DriveLinesMaker {
  std::string name;
  std::function<std::unique_ptr<DriveLines>()> make;
};

class DriveOverGpio : public testing::TestWithParam<DriveLinesMaker> {
 protected:
  // What must be gone before the kernel is asked whether everything was given back.
  struct Drive {
    explicit Drive(const DriveScene& scene)
        : draw(draw_plant(scene, 3)),
          vehicle(draw.vehicle, scene.start),
          camera(vehicle, draw.pose, 21),
          autopilot(vehicle, scene, draw, 22),
          left_line(hal::open_gpio_out({.chip = kDriveChip, .line = "BRAKE_LEFT"}).value()),
          right_line(hal::open_gpio_out({.chip = kDriveChip, .line = "BRAKE_RIGHT"}).value()),
          stop(hal::open_gpio_in({.chip = kDriveChip, .line = "STOP"}).value()),
          left(*left_line, servo::WhenActive::opens),
          right(*right_line, servo::WhenActive::opens),
          loop(scene.drive, {autopilot, camera, left, right, journal, nullptr, stop.get()},
               drive_mission(scene).value(), now) {}
    DrivePlantDraw draw;
    mocks::RollingVehicle vehicle;
    mocks::SimPoseSource camera;
    DirectAutopilot autopilot;
    std::unique_ptr<hal::DigitalOut> left_line;
    std::unique_ptr<hal::DigitalOut> right_line;
    std::unique_ptr<hal::DigitalIn> stop;
    servo::DigitalBrake left;
    servo::DigitalBrake right;
    hal::NullJournal journal;
    hal::Instant now{};
    flight::DriveLoop loop;
  };

  void SetUp() override {
    auto scene = load_drive_scene(test::source_path("scenes/course.toml"));
    ASSERT_TRUE(scene);
    scene_ = *std::move(scene);
    // A solenoid is all or nothing, and quick.
    scene_.ranges[static_cast<std::size_t>(DriveRange::servo_lag_s)] = {0.02, 0.02};
    drive_.emplace(scene_);
  }
  void TearDown() override {
    drive_.reset();
    EXPECT_FALSE(lines_->level(0) || lines_->level(1)) << "springs hold both";
  }
  [[nodiscard]] bool both_open() { return lines_->level(0) && lines_->level(1); }
  // One turn of the control loop; the brakes are pressed as the lines say.
  void step() {
    Drive& drive = *drive_;
    drive.autopilot.run(drive.now);
    drive.vehicle.push(drive.autopilot.thrust(), drive.autopilot.pitch_rad());
    drive.vehicle.press(lines_->level(0) ? 0.0 : 1.0, lines_->level(1) ? 0.0 : 1.0);
    drive.vehicle.update(drive.now);
    drive.loop.feed(drive.now);
    drive.loop.go(drive.now + std::chrono::milliseconds(100));
    drive.loop.update(drive.now);
    drive.now += std::chrono::milliseconds(10);
  }

  std::unique_ptr<DriveLines> lines_ = GetParam().make();
  DriveScene scene_;
  std::optional<Drive> drive_;
};

TEST_P(DriveOverGpio, ReachesTheGoalAndLeavesBothLinesWithoutCurrent) {
  bool opened = false;
  while (!drive_->loop.done() && drive_->now < hal::Instant{std::chrono::seconds(250)}) {
    step();
    opened = opened || both_open();
  }
  EXPECT_TRUE(opened);
  EXPECT_EQ(drive_->loop.status().end, flight::DriveEnd::arrived) << drive_->loop.status().detail;
  const servo::PathPose goal = scene_.path.back();
  const hal::Vec3 at = drive_->vehicle.state().pose.position;
  EXPECT_LT(std::hypot(at.x - goal.x_m, at.y - goal.y_m), 0.15);
}

// The button is a line of the kernel too.
TEST_P(DriveOverGpio, TheStopButtonEndsItInTheSameUpdate) {
  while (!both_open() && drive_->now < hal::Instant{std::chrono::seconds(30)}) step();
  ASSERT_TRUE(both_open());
  lines_->press_stop();
  step();
  EXPECT_EQ(drive_->loop.status().end, flight::DriveEnd::emergency_stop);
  EXPECT_FALSE(lines_->level(0) || lines_->level(1));
}

}  // namespace forager::boards
