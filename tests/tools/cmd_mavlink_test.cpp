// `forager mavlink` from outside: an autopilot emulated in the program, one behind a socket, one on a serial
// line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/linux/pseudo_terminal.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const Json* message(const Json& end, const std::string& name) {
  for (const Json& it : end["messages"])
    if (it["name"] == name) return &it;
  return nullptr;
}

TEST(CmdMavlink, ListenSaysWhoIsThereAndWhatComes) {
  const ProgramResult result = run_program({"mavlink", "listen", "--for", "5s", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json end = last_event(result.out, "end");
  ASSERT_GE(end["components"].size(), 1U);
  const Json& autopilot = end["components"][0];
  EXPECT_EQ(autopilot["autopilot"], "ArduPilot");
  EXPECT_EQ(autopilot["armed"], false);
  EXPECT_TRUE(end["why_none"].is_null()) << end["why_none"];
  const Json* heartbeat = message(end, "HEARTBEAT");
  ASSERT_NE(heartbeat, nullptr);
  EXPECT_NEAR((*heartbeat)["rate_hz"].get<double>(), 1.0, 0.21);
  EXPECT_EQ((*heartbeat)["loss_percent"], 0.0);
}

TEST(CmdMavlink, WhatIsAskedForComesAtItsRate) {
  const ProgramResult result = run_program(
      {"mavlink", "listen", "--for", "10s", "--ask", "ATTITUDE,SYS_STATUS", "--rate", "10", "--json"});
  const Json end = last_event(result.out, "end");
  const Json* attitude = message(end, "ATTITUDE");
  ASSERT_NE(attitude, nullptr) << result.out;
  EXPECT_NEAR((*attitude)["rate_hz"].get<double>(), 9.5, 1.0);
  EXPECT_GE(end["components"][0]["battery_percent"], 95);
}

TEST(CmdMavlink, TextIsATableAndEqualRunsPrintEqualBytes) {
  const std::vector<std::string> listen{"mavlink", "listen", "--for", "3s"};
  const ProgramResult result = run_program(listen);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1/1 ArduPilot, hexarotor, STABILIZE, disarmed"));
  EXPECT_THAT(result.out, HasSubstr("HEARTBEAT"));
  EXPECT_EQ(result.out.find('\x1b'), std::string::npos);
  EXPECT_EQ(run_program(listen).out, result.out);
}

TEST(CmdMavlink, RawPrintsFramesAsTheyCame) {
  const ProgramResult result = run_program({"mavlink", "listen", "--for", "2s", "--raw"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("v2 HEARTBEAT"));
  EXPECT_THAT(result.out, HasSubstr(" fd09"));  // start byte and length of a heartbeat
}

TEST(CmdMavlink, RefusesWhatCannotWork) {
  expect_refusals({
      {{"mavlink"}, 2, "listen"},
      {{"mavlink", "listen"}, 2, "--for"},
      {{"mavlink", "listen", "--for", "1", "--ask", "NONSENSE"}, 2, "NONSENSE"},
      {{"mavlink", "listen", "--for", "1", "--baud", "9600"}, 2, "--serial"},
      {{"mavlink", "listen", "--for", "1", "--listen", "nowhere"}, 2, "HOST:PORT"},
  });
}

class CmdMavlinkOverSockets : public SocketTest {
 protected:
  SocketRig rig_;
};

TEST_F(CmdMavlinkOverSockets, HearsAnEmulatedAutopilot) {
  rig_.start_autopilot();
  const ProgramResult result =
      run_program({"mavlink", "listen", "--board", rig_.file("board.toml"), "--for", "3s", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(last_event(result.out, "end")["components"][0]["autopilot"], "ArduPilot") << result.out;
}

TEST_F(CmdMavlinkOverSockets, SilenceIsExplained) {
  const ProgramResult result =
      run_program({"mavlink", "listen", "--board", rig_.file("board.toml"), "--for", "1s"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(std::to_string(rig_.mavlink_port)));
}

// The port by itself, and by the board file that a mission takes it from.
TEST(CmdMavlinkSerial, BytesThatAreNoFramesPointAtTheBaudRate) {
  auto far = hal::open_pseudo_terminal();
  ASSERT_TRUE(far);
  static_cast<void>((*far)->open());
  const test::ScratchFolder folder;
  const std::string board = folder.write(
      "robot.toml", "[board]\nname = \"robot\"\n[autopilot]\nserial = \"" + (*far)->port() + "\"\n");
  for (const auto& [option, place] : {std::pair{"--serial", (*far)->port()}, std::pair{"--board", board}}) {
    Program program({"mavlink", "listen", option, place, "--for", "1200ms"});
    program.wait_until(
        [&](const ProgramResult&) {
          static_cast<void>((*far)->poll());
          static_cast<void>(
              (*far)->write(std::as_bytes(std::span(std::string_view("\x12\x34\x56 no frame")))));
          return false;
        },
        20s);
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("another baud rate")) << option;
  }
}

TEST(CmdMavlinkSerial, APortThatIsNotThereIsNamed) {
  const ProgramResult result =
      run_program({"mavlink", "listen", "--serial", "/dev/ttyUSB77", "--for", "300ms"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("/dev/ttyUSB77"));
}

}  // namespace
}  // namespace forager::tools
