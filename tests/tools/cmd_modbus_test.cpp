// `forager modbus` from outside: an emulated device, and lines that are not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

struct Case {
  std::vector<std::string> arguments;
  int exit_code;
  std::string out;
  std::string err;
};

TEST(CmdModbus, ReadsWritesAndFindsAnEmulatedDevice) {
  const std::vector<Case> cases{
      {{"modbus", "read", "sim", "0", "--count", "2"},
       0,
       "    0    100  0x0064     100\n"
       "    1    200  0x00c8     200\n",
       ""},
      {{"modbus", "read", "sim", "0", "--count", "2", "--input"},
       0,
       "    0      7  0x0007       7\n"
       "    1  65535  0xffff      -1\n",
       ""},
      {{"modbus", "write", "sim", "2", "17", "18", "--arm"},
       0,
       "unit 1, holding register 2: 17 18 written; it stays until somebody writes again\n",
       ""},
      {{"modbus", "coil", "sim", "0", "on", "--arm"},
       0,
       "unit 1, coil 0: on; it stays until somebody writes again\n",
       ""},
      {{"modbus", "scan", "sim", "--to", "5"}, 0, "unit   1  register 0 is 100\n", ""},
      // An exception is an answer: the unit is there.
      {{"modbus", "scan", "sim", "--to", "5", "--register", "9"},
       0,
       "unit   1  exception 2, illegal data address: the device has no such register\n",
       ""},
      {{"modbus", "read", "sim", "9"},
       1,
       "",
       "forager: modbus fake: read: exception 2, illegal data address: the device has no such register. "
       "Compare the "
       "register map with the device's manual\n"},
      {{"modbus", "read", "sim", "0", "--unit", "2"}, 1, "", "forager: modbus fake: read: no answer\n"},
  };
  for (const Case& it : cases) {
    SCOPED_TRACE(testing::PrintToString(it.arguments));
    const ProgramResult result = run_program(it.arguments);
    EXPECT_EQ(result.exit_code, it.exit_code);
    EXPECT_EQ(result.out, it.out);
    EXPECT_EQ(result.err, it.err);
  }
}

class CmdModbusByName : public testing::Test {
 protected:
  std::vector<std::string> with_board(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "modbus");
    for (const std::string& more : {std::string("--board"), board_}) arguments.push_back(more);
    return arguments;
  }
  test::ScratchFolder folder_;
  std::string board_ = folder_.write("robot.toml", R"([board]
name = "robot"
[[modbus]]
name = "power"
bus = "sim"
[[modbus.device]]
name = "battery"
kind = "battery"
unit = 4
register = [
  { name = "voltage", address = 0, table = "input", scale = 0.01, unit = "V" },
  { name = "charge", address = 10, table = "input", type = "f32", scale = 0.01 },
  { name = "capacity", address = 20, type = "u32", word_order = "low_first", scale = 0.001, unit = "Ah" },
]
[[modbus.device]]
name = "actuator"
unit = 3
register = [ { name = "target", address = 40, scale = 0.1, offset = -10, unit = "mm" } ]
)");
};

TEST_F(CmdModbusByName, RegistersAreListedShownAndSetInTheUnitsOfTheirManual) {
  const std::vector<Case> cases{
      {{"list"},
       0,
       "battery: unit 4 on power (sim)\n"
       "  voltage          input 0 u16 x 0.01, V\n"
       "  charge           input 10 f32 x 0.01\n"
       "  capacity         holding 20 u32 low word first x 0.001, Ah\n"
       "actuator: unit 3 on power (sim)\n"
       "  target           holding 40 u16 x 0.1 + -10, mm\n",
       ""},
      {{"show", "battery", "capacity", "charge"}, 0, "capacity         10 Ah\ncharge           0.8\n", ""},
      {{"set", "power.actuator", "target", "12.34", "--arm"},
       0,
       "actuator: target is 12.3 mm; it stays until somebody writes again\n",
       ""},
  };
  for (const Case& it : cases) {
    SCOPED_TRACE(testing::PrintToString(it.arguments));
    const ProgramResult result = run_program(with_board(it.arguments));
    EXPECT_EQ(result.exit_code, it.exit_code);
    EXPECT_EQ(result.out, it.out);
    EXPECT_EQ(result.err, it.err);
  }
  const ProgramResult json = run_program(with_board({"show", "battery", "--json"}));
  EXPECT_EQ(lines_of(json.out).size(), 3U) << json.out;
  EXPECT_EQ(last_event(json.out, "value")["measured_in"], "Ah");
}

TEST_F(CmdModbusByName, WhatIsNotDeclaredCannotBeAskedFor) {
  expect_refusals({
      {with_board({"show", "batery"}), 2, "There are power.battery, power.actuator"},
      {with_board({"show", "battery", "current"}), 2, "It has voltage, charge, capacity"},
      {with_board({"set", "actuator", "target", "1"}), 2, "--arm"},
      {with_board({"set", "actuator", "target", "7000", "--arm"}), 2, "does not fit"},
      {with_board({"set", "battery", "voltage", "12", "--arm"}), 2, "can only be read"},
  });
}

TEST(CmdModbus, JsonHasTheSame) {
  const Json read =
      last_event(run_program({"modbus", "read", "sim", "1", "--count", "3", "--json"}).out, "registers");
  EXPECT_EQ(read["values"], Json::parse("[200, 300, 400]"));
  EXPECT_EQ(read["address"], 1);
}

TEST(CmdModbus, NobodyThereIsACheckThatFails) {
  const ProgramResult result = run_program({"modbus", "scan", "sim", "--from", "2", "--to", "9"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("nobody answers from unit 2 to 9"));
}

TEST(CmdModbus, NothingIsWrittenWithoutBeingAsked) {
  const std::vector<std::vector<std::string>> writes{{"modbus", "write", "sim", "0", "1"},
                                                     {"modbus", "coil", "sim", "0", "on"}};
  for (const auto& arguments : writes) {
    const ProgramResult result = run_program(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr("--arm"));
  }
}

TEST(CmdModbus, MistakesAreFoundBeforeTheLineIsTouched) {
  struct Wrong {
    std::vector<std::string> arguments;
    const char* says;
  };
  const std::vector<Wrong> cases{
      {{"modbus"}, "list, show, set, read, write, coil, scan"},
      {{"modbus", "read", "sim"}, "address"},
      {{"modbus", "read", "sim", "65536"}, "65536"},
      {{"modbus", "read", "sim", "0", "--count", "126"}, "126"},
      {{"modbus", "read", "sim", "0", "--count", "0"}, "'0'"},
      {{"modbus", "read", "sim", "0", "--unit", "248"}, "248"},
      {{"modbus", "write", "sim", "0", "70000", "--arm"}, "70000"},
      {{"modbus", "coil", "sim", "0", "maybe", "--arm"}, "maybe"},
      {{"modbus", "scan", "sim", "--from", "9", "--to", "2"}, "--from 9"},
      {{"modbus", "read", "sim", "0", "--timeout", "soon"}, "soon"},
      {{"modbus", "read", "sim", "0", "--parity", "mark"}, "mark"},
  };
  for (const Wrong& it : cases) {
    SCOPED_TRACE(testing::PrintToString(it.arguments));
    const ProgramResult result = run_program(it.arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(it.says));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

TEST(CmdModbus, ALineThatIsNotThereIsNamed) {
  const ProgramResult tcp = run_program({"modbus", "read", "127.0.0.1:1", "0"});
  if (tcp.exit_code == 3) GTEST_SKIP() << "built without libmodbus";
  EXPECT_EQ(tcp.exit_code, 1);
  EXPECT_THAT(tcp.err, HasSubstr("127.0.0.1:1"));
  const ProgramResult serial = run_program({"modbus", "read", "/dev/ttyUSB77", "0"});
  EXPECT_EQ(serial.exit_code, 3);
  EXPECT_THAT(serial.err, HasSubstr("/dev/ttyUSB77"));
}

}  // namespace
}  // namespace forager::tools
