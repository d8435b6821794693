// One controller, one brake pair, one vehicle: whatever backend the board file names, the pins do the same.
// The backends are the real ones; below them is a fake kernel, and below that the pins.
#include "boards/brake_devices.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "boards/board.hpp"
#include "flight/mavlink/mavlink_wire.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/text_journal.hpp"
#include "mocks/virtual_clock.hpp"
#include "servo/brake_steer.hpp"
#include "servo/brakes.hpp"
#include "tests/hal/linux/fake_gpio_calls.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

BrakeBoard board_of(const std::string& text) {
  const auto node = parse_config(text, "board.toml");
  ConfigIssue issue;
  ConfigReader top(&node.value(), "", issue);
  BrakeBoard board = read_brake_board(top.table("brakes"));
  check_unused(*node, issue);
  EXPECT_FALSE(issue.has_value()) << describe(*issue);
  return board;
}

// The machine below the backends.
class Machine {
 public:
  Machine() {
    auto& gpio = hal::fake::FakeGpio::get();
    gpio.reset();
    gpio.chips[0].label = "pinctrl-bcm2711";
    for (int i = 0; i < 28; ++i) gpio.chips[0].lines.push_back({.name = "GPIO" + std::to_string(i)});
    wires.attach(0x40, pca9685);
    kernel.files["/dev/i2c-1"] = std::make_shared<hal::fake::FakeI2cNode>(wires);
    hid.plug(bridge);
  }
  void pass(hal::Instant now) {
    pca9685.advance(now);
    while (const auto command = servos.due(now)) {  // an ArduPilot that takes what it is told
      outputs[static_cast<std::size_t>(command->param1)] =
          std::chrono::microseconds(std::lround(command->param2));
      servos.take({.command = flight::mavlink::command::kDoSetServo});
    }
  }
  mocks::VirtualClock clock{hal::Instant(1s)};
  hal::fake::FakeKernel kernel;
  hal::fake::FakePwmChip chip{kernel, clock, "pwmchip0", 2};
  mocks::SimI2cBus wires{"wires"};
  mocks::SimPca9685 pca9685;
  mocks::SimMcp2221 bridge{wires};
  mocks::FakeHid hid;
  flight::MavlinkServos servos{flight::MavlinkConfig{}};
  std::array<std::optional<hal::Duration>, 17> outputs{};
};

struct Backend {
  std::string name;
  std::string left;  // of [brakes.left]
  std::string right;
  // What the pin says, as the brake's fraction; nothing: the brake is not driven.
  std::function<std::optional<double>(Machine&, bool left)> pin;
};

double fraction_of(hal::Duration pulse, bool left) {
  const double locked_us = left ? 1725.0 : 1875.0;
  return (static_cast<double>(pulse.count()) / 1e3 - 1180.0) / (locked_us - 1180.0);
}
std::optional<double> fraction_of(std::optional<hal::Duration> pulse, bool left) {
  return pulse ? std::optional(fraction_of(*pulse, left)) : std::nullopt;
}

const Backend kSysfs{"sysfs", "backend = \"sysfs_pwm\"\nchannel = 0\n",
                     "backend = \"sysfs_pwm\"\nchannel = 1\n",
                     [](Machine& machine, bool left) -> std::optional<double> {
                       const auto& line = machine.chip.line(left ? 0 : 1);
                       if (!line.enabled) return std::nullopt;
                       return fraction_of(hal::Duration(line.duty), left);
                     }};
const Backend kPca9685{
    "pca9685", "backend = \"pca9685\"\nchannel = 4\n", "backend = \"pca9685\"\nchannel = 5\n",
    [](Machine& machine, bool left) { return fraction_of(machine.pca9685.pulse(left ? 4 : 5), left); }};
const Backend kPca9685OverUsb{"pca9685_over_usb", "backend = \"pca9685\"\nbus = \"mcp2221:SN0001\"\nchannel = 4\n",
                              "backend = \"pca9685\"\nbus = \"mcp2221:SN0001\"\nchannel = 5\n", kPca9685.pin};
const Backend kGpioOverUsb{"gpio_over_usb", "backend = \"gpio\"\nchip = \"mcp2221\"\nline = \"GP0\"\n",
                           "backend = \"gpio\"\nchip = \"mcp2221:SN0001\"\nline = \"GP3\"\nactive_low = true\n",
                           [](Machine& machine, bool left) -> std::optional<double> {
                             const bool energised = left ? machine.bridge.level(0) : !machine.bridge.level(3);
                             return energised ? 0.0 : 1.0;
                           }};
const Backend kGpio{"gpio", "backend = \"gpio\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO17\"\n",
                    "backend = \"gpio\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO27\"\nactive_low = true\n",
                    [](Machine&, bool left) -> std::optional<double> {
                      const auto& line = hal::fake::FakeGpio::get().chips[0].lines[left ? 17 : 27];
                      const bool energised = left ? line.level : !line.level;
                      return energised ? 0.0 : 1.0;  // spring-applied
                    }};
const Backend kAutopilot{
    "autopilot", "backend = \"autopilot\"\noutput = 9\n", "backend = \"autopilot\"\noutput = 10\n",
    [](Machine& machine, bool left) { return fraction_of(machine.outputs[left ? 9 : 10], left); }};

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

TEST(BrakeDevices, ALineSomebodyHoldsIsNamed) {
  Machine machine;
  mocks::TextJournal journal;
  auto& line = hal::fake::FakeGpio::get().chips[0].lines[17];
  line.used = true;
  line.consumer = "pwm-fan";
  const auto devices = open_brake_devices(
      board_of("[brakes]\n[brakes.left]\n" + kGpio.left + "[brakes.right]\n" + kGpio.right),
      {.clock = machine.clock, .journal = journal});
  ASSERT_FALSE(devices);
  EXPECT_EQ(hal::ErrorCode::busy, devices.error().code);
  EXPECT_THAT(describe(devices.error()), HasSubstr("\"pwm-fan\" holds the line"));
}

TEST(BrakeDevices, WithoutAnAutopilotItsOutputsCannotBeHad) {
  Machine machine;
  mocks::TextJournal journal;
  const auto devices = open_brake_devices(
      board_of("[brakes]\n[brakes.left]\n" + kAutopilot.left + "[brakes.right]\n" + kAutopilot.right),
      {.clock = machine.clock, .journal = journal});
  ASSERT_FALSE(devices);
  EXPECT_EQ(hal::ErrorCode::invalid_state, devices.error().code);
}

}  // namespace
}  // namespace forager::boards
