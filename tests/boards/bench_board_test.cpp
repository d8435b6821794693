// Tables of single devices in a board file, and what a person may write instead of a name.
#include "boards/bench_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

hal::Result<BenchBoard> read(const std::string& text) {
  const auto node = parse_config(text, "board.toml");
  if (!node) return hal::fail(node.error());
  ConfigIssue issue;
  ConfigReader top(&*node, "", issue);
  BenchBoard board = read_bench_board(top);
  check_unused(*node, issue);
  if (issue) return hal::fail(*issue);
  return board;
}
std::string complaint(const std::string& text) {
  const auto board = read(text);
  return board ? "nothing" : describe(board.error());
}

TEST(BenchBoard, ReadsEveryKindOfDevice) {
  const auto board = read(R"(
[[gpio]]
name = "stop"
chip = "pinctrl-bcm2711"
line = "GPIO5"
bias = "pull_up"
active_low = true
debounce_ms = 5
[[gpio]]
name = "lamp"
chip = "gpiochip0"
line = "6"
direction = "out"
drive = "open_drain"
at_end = "as_is"
[[servo]]
name = "tilt"
backend = "pca9685"
address = 0x41
channel = 3
from_us = 1200
to_us = 1800
trim_us = -12
safe = 0.25
at_halt = "release"
frequency_hz = 100
[[i2c]]
name = "imu"
bus = "1"
address = 0x68
[[serial]]
name = "telemetry"
port = "/dev/ttyUSB0"
baud = 57600
parity = "even"
speaks = "mavlink"
)");
  ASSERT_TRUE(board) << describe(board.error());
  EXPECT_EQ(board->lines[0].bias, BenchBias::pull_up);
  EXPECT_TRUE(board->lines[0].active_low);
  EXPECT_EQ(board->lines[0].debounce, 5ms);
  EXPECT_TRUE(board->lines[1].output && board->lines[1].keep_at_end);
  EXPECT_EQ(board->lines[1].drive, BenchDrive::open_drain);
  const BenchServo& servo = board->servos.front();
  EXPECT_EQ(to_string(servo.place), "/dev/i2c-1@0x41/3");
  EXPECT_EQ(servo.place.period, 10ms);
  EXPECT_EQ(servo.from, 1200us);
  EXPECT_EQ(servo.config.trim, -12us);
  EXPECT_EQ(servo.config.at_halt, servo::AtHalt::release);
  EXPECT_EQ(board->chips.front().bus, "/dev/i2c-1");
  EXPECT_EQ(board->serials.front().baud, 57600);
  EXPECT_EQ(board->serials.front().peer, SerialPeer::mavlink);
}

TEST(BenchBoard, MistakesAreNamedWithTheirLine) {
  EXPECT_THAT(complaint("[[gpio]]\nname = \"a\"\nchip = \"b\"\n"), HasSubstr("line"));
  EXPECT_THAT(complaint("[[gpio]]\nname = \"a/b\"\nchip = \"b\"\nline = \"1\"\n"),
              HasSubstr("has a / or @ in it"));
  EXPECT_THAT(complaint("[[i2c]]\nname = \"a\"\naddress = 9\n[[i2c]]\nname = \"a\"\naddress = 10\n"),
              HasSubstr("is there twice"));
  EXPECT_THAT(complaint("[[i2c]]\nname = \"a\"\naddress = 0x78\n"), HasSubstr("board.toml:3"));
  EXPECT_THAT(
      complaint("[[servo]]\nname = \"a\"\nbackend = \"sim\"\nchannel = 0\nfrom_us = 1500\nto_us = 1500\n"),
      HasSubstr("is the same pulse as from_us"));
  EXPECT_THAT(complaint("[[serial]]\nname = \"a\"\nport = \"b\"\nspeaks = \"mavlin\"\n"),
              HasSubstr("mavlink"));
  // A debounce is the inputs', a drive the outputs': on the other side it is an unknown key.
  EXPECT_THAT(
      complaint("[[gpio]]\nname = \"a\"\nchip = \"b\"\nline = \"1\"\ndirection = \"out\"\ndebounce_ms = 1\n"),
      HasSubstr("debounce_ms"));
}

TEST(BenchPlaces, AreTakenToTheLetterOrRefused) {
  const BenchBoard board;
  EXPECT_EQ(find_line(board, "/dev/gpiochip0/17")->chip, "/dev/gpiochip0");
  EXPECT_EQ(find_line(board, "pinctrl-bcm2711/GPIO17")->line, "GPIO17");
  EXPECT_EQ(find_pwm(board, "pwmchip0/1")->channel, 1U);
  EXPECT_EQ(find_pwm(board, "1@0x40/15")->bus, "/dev/i2c-1");
  EXPECT_EQ(find_chip(board, "i2c-3@64")->address, 0x40);
  for (const char* wrong : {"", "GPIO17", "/17", "gpiochip0/"})
    EXPECT_FALSE(find_line(board, wrong)) << wrong;
  for (const char* wrong :
       {"pwmchip0", "pwmchip0/", "pwmchip0/-1", "pwmchip0/1x", "1@0x40/16", "1@0x80/1", "@0x40/1"})
    EXPECT_FALSE(find_pwm(board, wrong)) << wrong;
  for (const char* wrong : {"1", "1@", "1@0x07", "1@0x78", "@0x40", "1@64x"})
    EXPECT_FALSE(find_chip(board, wrong)) << wrong;
}

TEST(BenchServos, BrakesThatAreServosAreSafeWhenLocked) {
  BrakeBoard brakes;
  brakes.named = true;
  brakes.left.backend = BrakeBackend::sysfs_pwm;
  brakes.left.chip = "pwmchip0";
  brakes.right.backend = BrakeBackend::gpio;
  BenchBoard board;
  add_brake_servos(board, brakes);
  ASSERT_EQ(board.servos.size(), 1U);
  EXPECT_EQ(board.servos[0].name, "brakes.left");
  EXPECT_EQ(board.servos[0].config.safe, 1.0);
  EXPECT_EQ(board.servos[0].to, brakes.left.pulses.locked_pulse);
}

}  // namespace
}  // namespace forager::boards
