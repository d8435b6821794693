// One controller, one brake pair, one vehicle: whatever backend the board file names, the pins do the same.
// The backends are the real ones; below them is a fake kernel, and below that the pins.
#include "boards/brake_devices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "mocks/text_journal.hpp"
#include "servo/brake_steer.hpp"
#include "servo/brakes.hpp"
#include "tests/boards/brakes/brake_machine.hpp"
#include "tests/hal/linux/fake_gpio_calls.hpp"

namespace forager::boards {
namespace {

class EveryBackend : public testing::TestWithParam<Backend> {
 protected:
  EveryBackend() { machine_.servos.set_link(true); }
  void open() {
    board_ = board_of("[brakes]\n[brakes.left]\n" + GetParam().left + "[brakes.right]\n" + GetParam().right);
    auto devices = open_brake_devices(board_, {.clock = machine_.clock,
                                               .journal = journal_,
                                               .autopilot = &machine_.servos,
                                               .kernel = &machine_.kernel,
                                               .hid = &machine_.hid});
    ASSERT_TRUE(devices) << describe(devices.error());
    devices_ = *std::move(devices);
    brakes_.emplace(devices_->left(), devices_->right(), journal_, board_.pair, machine_.clock.now());
  }
  void step() {
    machine_.clock.advance(10ms);
    const hal::Instant now = machine_.clock.now();
    ASSERT_TRUE(devices_->update(now));
    brakes_->update(now);
    machine_.pass(now);
  }
  void run(hal::Duration time) {
    for (const hal::Instant end = machine_.clock.now() + time; machine_.clock.now() < end;) step();
  }
  [[nodiscard]] std::optional<double> left() { return GetParam().pin(machine_, true); }
  [[nodiscard]] std::optional<double> right() { return GetParam().pin(machine_, false); }
  void expect_pins(double left_fraction, double right_fraction) {
    ASSERT_TRUE(left().has_value() && right().has_value());
    EXPECT_NEAR(left_fraction, *left(), 0.005);
    EXPECT_NEAR(right_fraction, *right(), 0.005);
  }

  mocks::TextJournal journal_;
  Machine machine_;
  BrakeBoard board_;
  std::unique_ptr<BrakeDevices> devices_;
  std::optional<servo::BrakePair> brakes_;
};

TEST_P(EveryBackend, LocksAtConstructionFollowsAndLocksWhenTheCommandRunsOut) {
  open();
  run(100ms);
  expect_pins(1.0, 1.0);
  brakes_->command({0.0, 1.0, machine_.clock.now() + 400ms});
  run(300ms);
  expect_pins(0.0, 1.0);
  run(400ms);
  expect_pins(1.0, 1.0);
  brakes_->command({1.0, 0.0, machine_.clock.now() + 10s});
  run(300ms);
  expect_pins(1.0, 0.0);
  brakes_->halt();
  machine_.pass(machine_.clock.now());
  expect_pins(1.0, 1.0);
}

TEST_P(EveryBackend, TheEndOfTheProgramLeavesThemLocked) {
  open();
  run(100ms);
  brakes_->command({0.0, 0.0, machine_.clock.now() + 10s});
  run(300ms);
  expect_pins(0.0, 0.0);
  brakes_.reset();
  machine_.pass(machine_.clock.now());
  devices_.reset();
  expect_pins(1.0, 1.0);
}

// Rolls freely, stops where a brake is locked, pivots about the wheel that is.
struct Vehicle {
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0, speed_m_s = 0.0, yaw_rate_rad_s = 0.0;

  void step(bool left_locked, bool right_locked, bool thrust, double dt_s) {
    constexpr double kHalfTrack = 0.5;
    if (left_locked && right_locked) {
      speed_m_s = std::max(0.0, speed_m_s - 3.0 * dt_s);
      yaw_rate_rad_s -= std::copysign(std::min(std::abs(yaw_rate_rad_s), 5.0 * dt_s), yaw_rate_rad_s);
    } else if (left_locked || right_locked) {
      const double side = left_locked ? 1.0 : -1.0;
      const double rate = std::max(0.0, side * yaw_rate_rad_s + (thrust ? 0.9 : -0.35) * dt_s);
      yaw_rate_rad_s = side * rate;
      speed_m_s = rate * kHalfTrack;
    } else {
      speed_m_s = std::max(0.0, speed_m_s + (thrust ? 0.7 : -0.25) * dt_s);
      yaw_rate_rad_s = 0.0;
    }
    heading_rad = hal::wrap_pi(heading_rad + yaw_rate_rad_s * dt_s);
    x_m += speed_m_s * std::cos(heading_rad) * dt_s;
    y_m += speed_m_s * std::sin(heading_rad) * dt_s;
  }
  [[nodiscard]] hal::Pose pose() const {
    hal::Pose pose;
    pose.position = {x_m, y_m, 0.0};
    pose.yaw_rad = heading_rad;
    return pose;
  }
};

TEST_P(EveryBackend, TheSameControllerBringsTheVehicleToItsGoalThroughThePins) {
  open();
  run(100ms);
  Vehicle vehicle;
  servo::BrakeSteer steer{servo::BrakeSteerConfig{}};
  const std::array goal{servo::SteerStep{2.0, 1.0}};
  ASSERT_TRUE(steer.begin(goal, std::nullopt, machine_.clock.now()));
  for (int tick = 0; tick < 6000 && !steer.done(); ++tick) {
    const hal::Instant now = machine_.clock.now();
    steer.renew(now + 1s);
    servo::SteerInput input;
    if (tick % 3 == 0) input.pose = hal::PoseSample{.stamp = now, .pose = vehicle.pose()};
    const servo::SteerOutput output = steer.update(input, now);
    brakes_->command(output.brakes);
    brakes_->observe({vehicle.speed_m_s, vehicle.yaw_rate_rad_s, now});
    step();
    const bool pushes = output.thrust > 0.0 && brakes_->thrust_allowed();
    vehicle.step(left().value_or(0.0) > 0.9, right().value_or(0.0) > 0.9, pushes, 0.01);
  }
  EXPECT_EQ(servo::SteerPhase::arrived, steer.phase()) << to_string(steer.fault());
  EXPECT_LT(std::hypot(vehicle.x_m - 2.0, vehicle.y_m - 1.0), 0.15);
  EXPECT_NE(servo::BrakeState::faulted, brakes_->state()) << brakes_->status().reason;
  EXPECT_GE(steer.stats().turns, 1U);
}

INSTANTIATE_TEST_SUITE_P(Brakes, EveryBackend,
                         testing::Values(kSysfs, kPca9685, kPca9685OverUsb, kGpio, kGpioOverUsb, kAutopilot),
                         [](const auto& backend) { return backend.param.name; });

}  // namespace
}  // namespace forager::boards
