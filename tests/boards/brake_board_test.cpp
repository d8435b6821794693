#include "boards/brake_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

hal::Result<BrakeBoard> read(const std::string& text) {
  const auto node = parse_config(text, "robot.toml");
  if (!node) return hal::fail(node.error());
  ConfigIssue issue;
  ConfigReader top(&*node, "", issue);
  BrakeBoard board = read_brake_board(top.table("brakes"));
  check_unused(*node, issue);
  if (issue) return hal::fail(*issue);
  return board;
}

std::string complaint(const std::string& left, const std::string& right = "backend = \"sim\"\n") {
  const auto board = read("[brakes]\n[brakes.left]\n" + left + "[brakes.right]\n" + right);
  return board ? "accepted" : describe(board.error());
}

TEST(BrakeBoard, WithoutATableThereAreNoBrakes) { EXPECT_FALSE(read("")->named); }

TEST(BrakeBoard, TheLaboratorysPulsesAreTheOnesItHasByItself) {
  const auto board = read("[brakes]\nleft = { backend = \"sim\" }\nright = { backend = \"sim\" }\n");
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(1180us, board->left.pulses.open_pulse);
  EXPECT_EQ(1725us, board->left.pulses.locked_pulse);
  EXPECT_EQ(1180us, board->right.pulses.open_pulse);
  EXPECT_EQ(1875us, board->right.pulses.locked_pulse);
  EXPECT_EQ(20ms, board->period);
}

TEST(BrakeBoard, EveryKeyArrives) {
  const auto board = read(R"([brakes]
frequency_hz = 100
half_track_m = 0.4
yaw_limit_rad_s = 0.2
hold_rise_k = 50
warn_rise_k = 30
max_locked_s = 120
[brakes.left]
backend = "pca9685"
bus = "/dev/i2c-7"
address = 0x41
channel = 15
timeout_ms = 30
open_us = 1000
locked_us = 2000
trim_us = -20
min_us = 900
max_us = 2100
slew_per_s = 5
at_halt = "release"
[brakes.right]
backend = "modbus"
bus = "192.168.1.30:502"
baud = 9600
parity = "odd"
timeout_ms = 15
unit = 3
target_register = 40
open_value = 900
locked_value = 100
measured_register = 50
enable_coil = 1
slew_per_s = 8
)");
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(10ms, board->period);
  EXPECT_DOUBLE_EQ(0.4, board->pair.watch.half_track_m);
  EXPECT_DOUBLE_EQ(0.2, board->pair.yaw_limit_rad_s);
  EXPECT_DOUBLE_EQ(50, board->pair.heat.hold_rise_k);
  EXPECT_DOUBLE_EQ(30, board->pair.heat.warn_rise_k);
  EXPECT_EQ(2min, board->pair.heat.max_locked);
  const BrakeLine& left = board->left;
  EXPECT_EQ(BrakeBackend::pca9685, left.backend);
  EXPECT_EQ("/dev/i2c-7", left.bus);
  EXPECT_EQ(0x41, left.address);
  EXPECT_EQ(15U, left.channel);
  EXPECT_EQ(30ms, left.timeout);
  EXPECT_EQ(2000us, left.pulses.locked_pulse);
  EXPECT_EQ(-20us, left.pulses.trim);
  EXPECT_EQ(900us, left.pulses.min_pulse);
  EXPECT_EQ(2100us, left.pulses.max_pulse);
  EXPECT_DOUBLE_EQ(5, left.pulses.slew_per_s);
  EXPECT_EQ(servo::AtHalt::release, left.pulses.at_halt);
  const BrakeLine& right = board->right;
  EXPECT_EQ("192.168.1.30:502", right.bus);
  EXPECT_EQ(9600, right.baud);
  EXPECT_EQ('O', right.parity);
  EXPECT_EQ(15ms, right.timeout);
  EXPECT_EQ(3, right.actuator.unit);
  EXPECT_EQ(40, right.actuator.target.address);
  EXPECT_EQ(900, right.actuator.open_value);
  EXPECT_EQ(100, right.actuator.locked_value);
  ASSERT_TRUE(right.actuator.measured);
  EXPECT_EQ(50, right.actuator.measured->address);
  EXPECT_EQ(servo::RegisterTable::input, right.actuator.measured->table);
  EXPECT_EQ(1, right.actuator.enable_coil);
  EXPECT_DOUBLE_EQ(8, right.actuator.slew_per_s);
}

TEST(BrakeBoard, AnActuatorsRegistersAreDeclaredAsItsManualDescribesThem) {
  const std::string brakes = R"([brakes]
left = { backend = "sim" }
[brakes.right]
backend = "modbus"
bus = "/dev/ttyUSB0"
target = { address = 40, type = "i32", word_order = "low_first", scale = 0.1, unit = "mm" }
measured = { address = 50, scale = 0.1 }
open_value = -4.5
locked_value = 41.5
)";
  const auto board = read(brakes);
  ASSERT_TRUE(board) << describe(board.error());
  const servo::ModbusBrakeConfig& actuator = board->right.actuator;
  EXPECT_EQ(servo::RegisterType::i32, actuator.target.type);
  EXPECT_EQ(servo::WordOrder::low_first, actuator.target.order);
  EXPECT_DOUBLE_EQ(0.1, actuator.target.scale);
  EXPECT_EQ(servo::RegisterTable::input, actuator.measured->table);
  EXPECT_DOUBLE_EQ(-4.5, actuator.open_value);
  const auto wrong = [&](const std::string& from, const std::string& to) {
    std::string text = brakes;
    text.replace(text.find(from), from.size(), to);
    const auto refused = read(text);
    return refused ? "accepted" : describe(refused.error());
  };
  EXPECT_THAT(wrong("type = \"i32\", word_order = \"low_first\",", ""), HasSubstr("does not fit"));
  EXPECT_THAT(wrong("address = 40,", "address = 40, table = \"input\","), HasSubstr("can only be read"));
  EXPECT_THAT(wrong("open_value", "target_register = 3\nopen_value"), HasSubstr("exclude each other"));
}

// A brake locks within 300 ms of whatever happens; what a turn of the loop waits for both is a part of it.
TEST(BrakeBoard, TheSlowestModbusActuatorsThatMayBeNamedAnswerInTime) {
  const auto board = read(R"([brakes]
[brakes.left]
backend = "modbus"
bus = "/dev/ttyUSB0"
timeout_ms = 50
measured_register = 2
enable_coil = 1
[brakes.right]
backend = "modbus"
bus = "/dev/ttyUSB0"
timeout_ms = 50
unit = 2
measured_register = 2
enable_coil = 1
)");
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(150ms, longest_wait(board->left)) << "coil, target and position";
  EXPECT_LE(longest_wait(board->left) + longest_wait(board->right), 300ms);
  EXPECT_EQ(0ms, longest_wait(BrakeLine{}));
}

TEST(BrakeBoard, MistakesAreNamedWithTheirPlace) {
  EXPECT_THAT(complaint(""), HasSubstr("backend"));
  EXPECT_THAT(complaint("backend = \"pwm\"\n"), HasSubstr("sysfs_pwm"));
  EXPECT_THAT(complaint("backend = \"sysfs_pwm\"\n"), HasSubstr("channel"));
  EXPECT_THAT(complaint("backend = \"gpio\"\nchip = \"gpiochip0\"\n"), HasSubstr("line"));
  EXPECT_THAT(complaint("backend = \"software_pwm\"\nchip = \"gpiochip0\"\n"), HasSubstr("line"));
  EXPECT_THAT(complaint("backend = \"software_pwm\"\nchip = \"gpiochip0\"\nline = \"4\"\nlocked_us = 1180\n"),
              HasSubstr("same pulse"));
  EXPECT_THAT(complaint("backend = \"autopilot\"\n"), HasSubstr("output"));
  EXPECT_THAT(complaint("backend = \"modbus\"\n"), HasSubstr("bus"));
  EXPECT_THAT(complaint("backend = \"modbus\"\nbus = \"/dev/ttyUSB0\"\ntimeout_ms = 51\n"), HasSubstr("50"));
  EXPECT_THAT(complaint("backend = \"sim\"\nchannel = 3\n"), HasSubstr("channel"));  // it has none
  EXPECT_THAT(complaint("backend = \"sim\"\nslew_per_s = 3\n"), HasSubstr("slew_per_s"));
  EXPECT_THAT(complaint("backend = \"sim\"\nlocked_us = 1180\n"), HasSubstr("same pulse"));
  EXPECT_THAT(complaint("backend = \"sim\"\nlocked_us = 2100\n"), HasSubstr("cut off"));
  EXPECT_THAT(complaint("backend = \"sim\"\nlocked_us = 2600\n"), HasSubstr("2500"));
  EXPECT_THAT(complaint("backend = \"sysfs_pwm\"\nchannel = 0\n", "backend = \"sysfs_pwm\"\nchannel = 0\n"),
              HasSubstr("same output"));
  EXPECT_THAT(describe(read("[brakes]\nleft = { backend = \"sim\" }\n").error()), HasSubstr("brakes.right"));
  EXPECT_EQ("accepted", complaint("backend = \"pca9685\"\nchannel = 0\n",
                                  "backend = \"pca9685\"\nchannel = 0\naddress = 0x41\n"));
}

}  // namespace
}  // namespace forager::boards
