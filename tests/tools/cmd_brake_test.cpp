// `forager brake` from outside, on emulated brakes and on hardware this machine does not have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/sysfs_tree.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

nlohmann::json last_state(const std::string& out) {
  nlohmann::json last;
  for (const auto& line : lines_of(out))
    if (line["event"] == "state") last = line;
  return last;
}

TEST(CmdBrake, ListSaysWhereBothAre) {
  const ProgramResult text = run_program({"brake", "list"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_EQ(text.out,
            "left   sim        in this process; open 1180 us, locked 1725 us\n"
            "right  sim        in this process; open 1180 us, locked 1875 us\n");
  const auto json = lines_of(run_program({"brake", "list", "--json"}).out);
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[1]["side"], "right");
  EXPECT_EQ(json[1]["backend"], "sim");
}

TEST(CmdBrake, SetMovesThemForTheTimeGivenAndLocksThem) {
  const ProgramResult result =
      run_program({"brake", "set", "--arm", "--left", "0", "--right", "0.5", "--hold", "1", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  double most_open = 1.0;
  double held_from = 0.0;
  double held_to = 0.0;
  for (const auto& line : lines_of(result.out)) {
    if (line["event"] != "state") continue;
    if (line["left"] < most_open) held_from = line["t_s"];
    most_open = std::min<double>(most_open, line["left"]);
    if (line["left"] > most_open && held_to == 0.0) held_to = line["t_s"];
  }
  EXPECT_EQ(most_open, 0.0);
  EXPECT_NEAR(held_to - held_from, 0.9, 0.03);  // a tenth of a second for the way there
  const auto last = last_state(result.out);
  EXPECT_EQ(last["state"], "halted");
  EXPECT_EQ(last["left"], 1.0);
  EXPECT_EQ(last["right"], 1.0);
  EXPECT_THAT(last["left_output"].get<std::string>(), HasSubstr("1725.0 us"));
  EXPECT_THAT(last["right_output"].get<std::string>(), HasSubstr("1875.0 us"));
  EXPECT_EQ(last["cut_thrust"], true);
}

TEST(CmdBrake, EqualRunsPrintEqualBytes) {
  const std::vector<std::string> set{"brake", "set", "--arm", "--left", "0", "--hold", "0.5"};
  EXPECT_EQ(run_program(set).out, run_program(set).out);
}

TEST(CmdBrake, WatchLocksThemAndSaysSo) {
  const ProgramResult result = run_program({"brake", "watch", "--arm", "--for", "2", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto states = lines_of(result.out);
  EXPECT_THAT(result.out, HasSubstr("\"state\":\"engaged\""));
  EXPECT_EQ(last_state(result.out)["left"], 1.0);
}

TEST(CmdBrake, CtrlCLeavesThemLocked) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Program program(
        {"brake", "set", "--arm", "--left", "0", "--right", "0", "--hold", "60", "--real-time", "--json"});
    ASSERT_TRUE(program.wait_for_out("\"left\":0.0", 10s));
    program.send_signal(signal);
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(last_state(result.out)["state"], "halted");
    EXPECT_THAT(last_state(result.out)["left_output"].get<std::string>(), HasSubstr("1725.0 us"));
  }
  Program watch({"brake", "watch", "--arm", "--real-time"});
  ASSERT_TRUE(watch.wait_for_out("engaged", 10s));
  watch.send_signal(SIGINT);
  EXPECT_EQ(watch.finish().exit_code, 0);
}

TEST(CmdBrake, NothingMovesWithoutBeingAsked) {
  expect_refusal({"brake", "set", "--left", "0", "--hold", "1"}, 2, HasSubstr("--arm"));
  expect_refusal({"brake", "watch", "--for", "1"}, 2, HasSubstr("--arm"));
  expect_refusal({"brake", "watch", "--arm"}, 2, HasSubstr("--for"));
  expect_refusal({"brake", "set", "--arm"}, 2, HasSubstr("--hold"));
  expect_refusal({"brake", "set", "--arm", "--hold", "1", "--left", "1.1"}, 2, HasSubstr("1.1"));
  expect_refusal({"brake", "set", "--arm", "--hold", "1", "--left", "0x"}, 2, HasSubstr("0x"));
  expect_refusal({"brake", "set", "--arm", "--hold", "nan"}, 2, HasSubstr("nan"));
  expect_refusal({"brake"}, 2, HasSubstr("list, set, watch"));
}

class CmdBrakeOnABoard : public testing::Test {
 protected:
  std::string board(const std::string& brakes) {
    return folder_.write("robot.toml", "[board]\nname = \"robot\"\n" + brakes);
  }
  test::ScratchFolder folder_;
};

TEST_F(CmdBrakeOnABoard, ListReadsTheFileAndOpensNothing) {
  const std::string file = board(R"([brakes]
left = { backend = "gpio", chip = "no-such-chip", line = "GPIO17" }
right = { backend = "pca9685", bus = "/dev/i2c-77", address = 0x41, channel = 3 }
)");
  const ProgramResult result = run_program({"brake", "list", "--board", file});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "left   gpio       no-such-chip GPIO17; active opens\n"
            "right  pca9685    /dev/i2c-77 0x41 channel 3; open 1180 us, locked 1875 us\n");
}

TEST_F(CmdBrakeOnABoard, HardwareThatIsNotThereIsNamedWithItsMend) {
  const auto set = [&](const std::string& line) {
    return std::vector<std::string>{"brake",
                                    "set",
                                    "--arm",
                                    "--hold",
                                    "1",
                                    "--board",
                                    board("[brakes]\nleft = " + line + "\nright = { backend = \"sim\" }\n")};
  };
  expect_refusal(set(R"({ backend = "sysfs_pwm", chip = "pwmchip77", channel = 0 })"), 3,
                 AllOf(HasSubstr("pwmchip77"), HasSubstr("dtoverlay")));
  expect_refusal(set(R"({ backend = "pca9685", bus = "/dev/i2c-77", channel = 0 })"), 3,
                 AllOf(HasSubstr("/dev/i2c-77"), HasSubstr("modprobe i2c-dev")));
  expect_refusal(set(R"({ backend = "gpio", chip = "no-such-chip", line = "GPIO17" })"), 3,
                 HasSubstr("gpio no-such-chip/GPIO17"));
}

TEST_F(CmdBrakeOnABoard, AnActuatorThatDoesNotAnswerIsAFault) {
  const std::string file = board(R"([brakes]
left = { backend = "sim" }
right = { backend = "modbus", bus = "127.0.0.1:1", timeout_ms = 20 }
)");
  const ProgramResult result =
      run_program({"brake", "set", "--arm", "--left", "0", "--hold", "5", "--board", file, "--json"});
  if (result.exit_code == 3) GTEST_SKIP() << "built without libmodbus";
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("right brake, output"), HasSubstr("127.0.0.1:1")));
  EXPECT_THAT(result.out, HasSubstr("\"state\":\"faulted\""));
  EXPECT_EQ(last_state(result.out)["left"], 1.0);
}

class CmdBrakeOnKernelPwm : public CmdBrakeOnABoard {
 protected:
  // Two servos, and nothing that happens by itself.
  std::vector<std::string> watch() {
    const auto line = [&](int channel) {
      return "{ backend = \"sysfs_pwm\", chip = \"" + tree_.chip() +
             "\", channel = " + std::to_string(channel) + " }\n";
    };
    return {"brake",   "watch",
            "--arm",   "--json",
            "--board", board("guard_timeout_ms = 10000\n[brakes]\nleft = " + line(0) + "right = " + line(1))};
  }
  test::SysfsTree tree_;
};

TEST_F(CmdBrakeOnKernelPwm, TwoProgramsExcludeEachOther) {
  Program first(watch());
  ASSERT_TRUE(first.wait_for_out("\"state\":\"engaged\"", 10s)) << first.so_far().err;
  const ProgramResult second = run_program(watch());
  EXPECT_NE(second.exit_code, 0);
  EXPECT_THAT(second.err, AllOf(HasSubstr("pwmchip0/0"), HasSubstr("(forager) drives this channel")));
  first.send_signal(SIGINT);
  EXPECT_EQ(first.finish().exit_code, 0);
}

// It is held all the time, and cannot be told any more when the program ends.
TEST_F(CmdBrakeOnKernelPwm, ALastLockThatFailsIsAFailure) {
  Program program(watch());
  ASSERT_TRUE(program.wait_for_out("\"state\":\"engaged\"", 10s)) << program.so_far().err;
  std::filesystem::remove(tree_.chip() + "/pwm1/duty_cycle");
  program.send_signal(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_THAT(result.err, AllOf(HasSubstr("right brake"), HasSubstr("pwm1/duty_cycle")));
}

TEST_F(CmdBrakeOnABoard, AnAutopilotThatIsSilentIsAFailure) {
  const std::string file = board(R"([autopilot]
address = "127.0.0.1:9"
[brakes]
left = { backend = "autopilot", output = 9 }
right = { backend = "autopilot", output = 10 }
)");
  const ProgramResult result =
      run_program({"brake", "set", "--arm", "--hold", "1", "--connect-within", "0.2", "--board", file});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("none came within 0.2 s"), HasSubstr("autopilot.address")));
}

TEST_F(CmdBrakeOnABoard, ABoardWithoutBrakesHasNone) {
  expect_refusal({"brake", "list", "--board", board("")}, 2, HasSubstr("no table [brakes]"));
  expect_refusal({"brake", "list", "--board",
                  board("[brakes]\nleft = { backend = \"hand\" }\nright = { backend = \"sim\" }\n")},
                 2, AllOf(HasSubstr("robot.toml:4"), HasSubstr("sysfs_pwm")));
}

}  // namespace
}  // namespace forager::tools
