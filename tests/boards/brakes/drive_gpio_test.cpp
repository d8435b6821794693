// The drive loop on the real GPIO backend: spring-applied brakes on two lines of the kernel, opened by
// current.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

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

constexpr const char* kChip = "pinctrl-bcm2711";

// The course's vehicle and autopilot, its brakes and its stop button on lines of the kernel.
class DriveOverGpio : public testing::Test {
 protected:
  // What must be gone before the kernel is asked whether everything was given back.
  struct Drive {
    explicit Drive(const DriveScene& scene)
        : draw(draw_plant(scene, 3)),
          vehicle(draw.vehicle, scene.start),
          camera(vehicle, draw.pose, 21),
          autopilot(vehicle, scene, draw, 22),
          left_line(hal::open_gpio_out({.chip = kChip, .line = "BRAKE_LEFT"}).value()),
          right_line(hal::open_gpio_out({.chip = kChip, .line = "BRAKE_RIGHT"}).value()),
          stop(hal::open_gpio_in({.chip = kChip, .line = "STOP"}).value()),
          left(*left_line, servo::WhenActive::opens),
          right(*right_line, servo::WhenActive::opens),
          loop(scene.drive, {autopilot, camera, left, right, journal, nullptr, stop.get()},
               drive_mission(scene).value(), now) {}
    // One turn of the control loop; the brakes are pressed as the lines say.
    void step() {
      autopilot.run(now);
      vehicle.push(autopilot.thrust(), autopilot.pitch_rad());
      vehicle.press(level(0) ? 0.0 : 1.0, level(1) ? 0.0 : 1.0);
      vehicle.update(now);
      loop.feed(now);
      loop.go(now + 100ms);
      loop.update(now);
      now += 10ms;
    }
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
    Instant now{};
    flight::DriveLoop loop;
  };

  void SetUp() override {
    FakeGpio::get().reset();
    FakeGpio::get().chips[0] = {.label = kChip,
                                .lines = {{.name = "BRAKE_LEFT"}, {.name = "BRAKE_RIGHT"}, {.name = "STOP"}}};
    auto scene = load_drive_scene(FORAGER_SOURCE_DIR "/scenes/course.toml");
    ASSERT_TRUE(scene);
    scene_ = *std::move(scene);
    // A solenoid is all or nothing, and quick.
    scene_.ranges[static_cast<std::size_t>(DriveRange::servo_lag_s)] = {0.02, 0.02};
    drive_.emplace(scene_);
  }
  void TearDown() override {
    drive_.reset();
    EXPECT_FALSE(level(0) || level(1)) << "springs hold both";
    EXPECT_EQ(FakeGpio::get().open_handles(), 0U);
  }
  static bool level(std::size_t line) { return FakeGpio::get().chips.at(0).lines.at(line).level; }
  [[nodiscard]] static bool both_open() { return level(0) && level(1); }

  DriveScene scene_;
  std::optional<Drive> drive_;
};

TEST_F(DriveOverGpio, ReachesTheGoalAndLeavesBothLinesWithoutCurrent) {
  bool opened = false;
  while (!drive_->loop.done() && drive_->now < Instant{250s}) {
    drive_->step();
    opened = opened || both_open();
  }
  EXPECT_TRUE(opened);
  EXPECT_EQ(drive_->loop.status().end, flight::DriveEnd::arrived) << drive_->loop.status().detail;
  const servo::PathPose goal = scene_.path.back();
  const hal::Vec3 at = drive_->vehicle.state().pose.position;
  EXPECT_LT(std::hypot(at.x - goal.x_m, at.y - goal.y_m), 0.15);
}

// The button is a line of the kernel too.
TEST_F(DriveOverGpio, TheStopButtonEndsItInTheSameUpdate) {
  while (!both_open() && drive_->now < Instant{30s}) drive_->step();
  ASSERT_TRUE(both_open());
  FakeGpio::get().chips.at(0).lines[2].level = true;
  drive_->step();
  EXPECT_EQ(drive_->loop.status().end, flight::DriveEnd::emergency_stop);
  EXPECT_FALSE(level(0) || level(1));
}

}  // namespace
}  // namespace forager::boards
