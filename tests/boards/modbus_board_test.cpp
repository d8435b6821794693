#include "boards/modbus_board.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "boards/board.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr const char* kBoard = R"([board]
name = "bench"
[[modbus]]
name = "power"
bus = "sim"
timeout_ms = 80

[[modbus.device]]
name = "battery"
kind = "battery"
unit = 4
poll_ms = 500
[[modbus.device.register]]
name = "voltage"
address = 0
table = "input"
scale = 0.01
unit = "V"
[[modbus.device.register]]
name = "charge"
address = 10
table = "input"
type = "f32"
scale = 0.01
[[modbus.device.register]]
name = "capacity"
address = 20
type = "u32"
word_order = "low_first"
scale = 0.001
unit = "Ah"

[[modbus.device]]
name = "dock"
kind = "charger"
unit = 5
enable_coil = 0
[[modbus.device.register]]
name = "status"
address = 0
table = "input"
)";

class ModbusBoardTest : public testing::Test {
 protected:
  std::string complaint(const std::string& from, const std::string& to) {
    std::string text = kBoard;
    const auto at = text.find(from);
    EXPECT_NE(std::string::npos, at);
    text.replace(at, from.size(), to);
    const auto board = load_board(folder_.write("wrong.toml", text));
    return board ? "accepted" : describe(board.error());
  }
  test::ScratchFolder folder_;
  mocks::VirtualClock clock_;
};

TEST_F(ModbusBoardTest, DeclaredRegistersAreReadFromTheEmulatedLine) {
  const auto board = load_board(folder_.write("board.toml", kBoard));
  ASSERT_TRUE(board) << describe(board.error());
  ASSERT_EQ(1U, board->modbus.size());
  const ModbusLine& line = board->modbus[0];
  EXPECT_EQ(80ms, line.timeout);
  EXPECT_EQ("19200 8E1", hal::to_string(line.line));
  const auto bus = open_modbus(line, clock_).value();
  const ModbusDevice* battery = line.find("battery");
  ASSERT_NE(nullptr, battery);
  EXPECT_NEAR(10.0, servo::read(*bus, battery->unit, *battery->find("capacity")).value(), 1e-9);
  auto gauge = make_battery(*bus, *battery).value();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(gauge.update(clock_.now()));
    clock_.advance(10ms);
  }
  EXPECT_NEAR(0.8, gauge.reading()->charge, 1e-3);
  auto dock = make_charger(*bus, *line.find("dock")).value();
  for (int i = 0; i < 60; ++i) {
    dock.charge_until(clock_.now() + 500ms);
    ASSERT_TRUE(dock.update(clock_.now()));
    clock_.advance(20ms);
  }
  EXPECT_TRUE(dock.reading()->charging);
  EXPECT_FALSE(make_battery(*bus, *line.find("dock")));
}

TEST_F(ModbusBoardTest, MistakesAreNamedWithTheirPlace) {
  EXPECT_THAT(complaint("name = \"charge\"", "name = \"charges\""),
              HasSubstr("has no \"charge\", which a battery needs"));
  EXPECT_THAT(complaint("type = \"f32\"", "type = \"f64\""), HasSubstr("f64"));
  EXPECT_THAT(complaint("address = 20", "address = 65535"), HasSubstr("make no register"));
  EXPECT_THAT(complaint("name = \"dock\"", "name = \"battery\""), HasSubstr("stands twice"));
  EXPECT_THAT(complaint("unit = 5", "unit = 300"), HasSubstr("unit"));
  EXPECT_THAT(complaint("name = \"status\"", "name = \"status\"\nscale = 2"), HasSubstr("plain u16"));
  EXPECT_THAT(complaint("bus = \"sim\"", "port = \"sim\""), HasSubstr("bus"));
}

TEST_F(ModbusBoardTest, TheAutopilotIsOnASerialPortOrOnAnAddress) {
  const auto load = [&](const std::string& autopilot) {
    return load_board(folder_.write("board.toml", "[board]\nname = \"b\"\n[autopilot]\n" + autopilot));
  };
  const auto serial = load("serial = \"/dev/ttyACM0\"\nbaud = 921600\nflow = \"hardware\"\n");
  ASSERT_TRUE(serial) << describe(serial.error());
  EXPECT_EQ("/dev/ttyACM0", serial->autopilot_serial);
  EXPECT_EQ("921600 8N1 rts/cts", hal::to_string(serial->autopilot_line));
  EXPECT_THAT(describe(load("serial = \"/dev/a\"\naddress = \"1.2.3.4:5\"\n").error()),
              HasSubstr("exclude each other"));
  EXPECT_THAT(describe(load("baud = 57600\n").error()), HasSubstr("serial port"));
}

}  // namespace
}  // namespace forager::boards
