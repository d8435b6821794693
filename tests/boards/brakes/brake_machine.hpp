#pragma once

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "boards/board.hpp"
#include "boards/brake_devices.hpp"
#include "flight/mavlink/mavlink_wire.hpp"
#include "mocks/fake_hid.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/linux/fake_gpio_kernel.hpp"
#include "tests/hal/linux/fake_i2c_node.hpp"
#include "tests/hal/linux/fake_kernel.hpp"
#include "tests/hal/linux/fake_pwm_chip.hpp"

// The real backends of brakes above a fake kernel, and the pins below it.
namespace forager::boards {

using namespace std::chrono_literals;

inline BrakeBoard board_of(const std::string& text) {
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

inline double fraction_of(hal::Duration pulse, bool left) {
  const double locked_us = left ? 1725.0 : 1875.0;
  return (static_cast<double>(pulse.count()) / 1e3 - 1180.0) / (locked_us - 1180.0);
}
inline std::optional<double> fraction_of(std::optional<hal::Duration> pulse, bool left) {
  return pulse ? std::optional(fraction_of(*pulse, left)) : std::nullopt;
}

inline const Backend kSysfs{"sysfs", "backend = \"sysfs_pwm\"\nchannel = 0\n",
                            "backend = \"sysfs_pwm\"\nchannel = 1\n",
                            [](Machine& machine, bool left) -> std::optional<double> {
                              const auto& line = machine.chip.line(left ? 0 : 1);
                              if (!line.enabled) return std::nullopt;
                              return fraction_of(hal::Duration(line.duty), left);
                            }};
inline const Backend kPca9685{
    "pca9685", "backend = \"pca9685\"\nchannel = 4\n", "backend = \"pca9685\"\nchannel = 5\n",
    [](Machine& machine, bool left) { return fraction_of(machine.pca9685.pulse(left ? 4 : 5), left); }};
inline const Backend kPca9685OverUsb{
    "pca9685_over_usb", "backend = \"pca9685\"\nbus = \"mcp2221:SN0001\"\nchannel = 4\n",
    "backend = \"pca9685\"\nbus = \"mcp2221:SN0001\"\nchannel = 5\n", kPca9685.pin};
inline const Backend kGpioOverUsb{
    "gpio_over_usb", "backend = \"gpio\"\nchip = \"mcp2221\"\nline = \"GP0\"\n",
    "backend = \"gpio\"\nchip = \"mcp2221:SN0001\"\nline = \"GP3\"\nactive_low = true\n",
    [](Machine& machine, bool left) -> std::optional<double> {
      const bool energised = left ? machine.bridge.level(0) : !machine.bridge.level(3);
      return energised ? 0.0 : 1.0;
    }};
inline const Backend kGpio{
    "gpio", "backend = \"gpio\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO17\"\n",
    "backend = \"gpio\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO27\"\nactive_low = true\n",
    [](Machine&, bool left) -> std::optional<double> {
      const auto& line = hal::fake::FakeGpio::get().chips[0].lines[left ? 17 : 27];
      const bool energised = left ? line.level : !line.level;
      return energised ? 0.0 : 1.0;  // spring-applied
    }};
inline const Backend kAutopilot{
    "autopilot", "backend = \"autopilot\"\noutput = 9\n", "backend = \"autopilot\"\noutput = 10\n",
    [](Machine& machine, bool left) { return fraction_of(machine.outputs[left ? 9 : 10], left); }};

}  // namespace forager::boards
