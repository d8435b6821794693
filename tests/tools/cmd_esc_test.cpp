// `forager esc` from outside, on emulated ESCs.
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

constexpr const char* kSentence = "the propellers are off";

void expect_usage(const std::vector<std::string>& arguments,
                  const testing::Matcher<const std::string&>& says) {
  expect_refusal(arguments, 2, says);
}

TEST(CmdEsc, ListSaysWhatTheLinesMean) {
  const ProgramResult text = run_program({"esc", "list"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, AllOf(HasSubstr("emulated"), HasSubstr("front-left"), HasSubstr("50.0 Hz")));
  const auto json = lines_of(run_program({"esc", "list", "--json"}).out);
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["motors"].size(), 4U);
  EXPECT_EQ(json[0]["stop_us"], 1000.0);
}

TEST(CmdEsc, TurnsOneMotorAndStops) {
  const ProgramResult result =
      run_program({"esc", "run", "--arm", "--props-off", kSentence, "--motor", "rear-left", "--throttle",
                   "0.2", "--hold", "2", "--json", "--pulses"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto lines = lines_of(result.out);
  double most_rear_left = 0.0;
  for (const auto& line : lines) {
    if (line["event"] != "note" || line["source"] != "esc") continue;
    const std::string text = line["text"];
    const auto at = text.find(" us");
    if (at == std::string::npos || !text.ends_with(" us")) continue;
    const auto blank = text.rfind(' ', at - 1);
    const double us = std::stod(text.substr(blank + 1));
    if (text.starts_with("rear-left"))
      most_rear_left = std::max(most_rear_left, us);
    else
      EXPECT_LE(us, 1060.0) << text;
  }
  EXPECT_NEAR(most_rear_left, 1060.0 + 0.2 * 800.0, 0.2);
  const auto& end = lines.back();
  EXPECT_EQ(end["event"], "end");
  for (const auto& motor : end["motors"]) EXPECT_EQ(motor["pulse_us"], 1000.0);
}

TEST(CmdEsc, CalibratesTheEmulatedOnes) {
  const ProgramResult result = run_program({"esc", "calibrate", "--arm", "--props-off", kSentence, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto end = lines_of(result.out).back();
  for (const auto& motor : end["motors"]) {
    EXPECT_EQ(motor["emulated"]["calibrated"], true);
    EXPECT_EQ(motor["emulated"]["stop_us"], 1062.5);
    EXPECT_EQ(motor["emulated"]["full_us"], 1937.5);
    EXPECT_EQ(motor["pulse_us"], 1000.0);
  }
}

TEST(CmdEsc, StopLeavesStopPulses) {
  const ProgramResult result = run_program({"esc", "stop", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto lines = lines_of(result.out);
  for (const auto& motor : lines.back()["motors"]) EXPECT_EQ(motor["pulse_us"], 1000.0);
}

TEST(CmdEsc, CtrlCStopsTheMotors) {
  Program program({"esc", "run", "--arm", "--props-off", kSentence, "--throttle", "0.3", "--hold", "60",
                   "--real-time", "--json"});
  ASSERT_TRUE(program.wait_for_out("arming -> armed", 15s)) << program.so_far().err;
  program.send_signal(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("SIGINT"));
  const auto end = lines_of(result.out).back();
  EXPECT_EQ(end["event"], "end");
  EXPECT_EQ(end["state"], "stopped");
  for (const auto& motor : end["motors"]) EXPECT_EQ(motor["pulse_us"], 1000.0);
}

TEST(CmdEsc, NothingTurnsWithoutArmAndTheSentence) {
  expect_usage({"esc", "run", "--throttle", "0.2", "--hold", "1"}, HasSubstr("--arm"));
  expect_usage({"esc", "run", "--arm", "--throttle", "0.2", "--hold", "1"}, HasSubstr(kSentence));
  expect_usage({"esc", "run", "--arm", "--props-off", "yes", "--throttle", "0.2", "--hold", "1"},
               HasSubstr(kSentence));
  expect_usage({"esc", "calibrate", "--props-off", kSentence}, HasSubstr("--arm"));
  expect_usage({"esc", "calibrate", "--arm"}, HasSubstr(kSentence));
}

TEST(CmdEsc, SaysWhatIsWrongWithTheRequest) {
  const auto with = [](std::vector<std::string> more) {
    std::vector<std::string> all{"esc", "run", "--arm", "--props-off", kSentence};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  expect_usage(with({"--throttle", "1.2", "--hold", "1"}), HasSubstr("1.2"));
  expect_usage(with({"--throttle", "nan", "--hold", "1"}), HasSubstr("nan"));
  expect_usage(with({"--throttle", "0.2", "--hold", "0"}), HasSubstr("--hold"));
  expect_usage(with({"--hold", "1"}), HasSubstr("--throttle"));
  expect_usage(with({"--throttle", "0.2"}), HasSubstr("--hold"));
  expect_usage(with({"--throttle", "0.2", "--hold", "1", "--motor", "left"}),
               AllOf(HasSubstr("'left'"), HasSubstr("rear-left")));
  expect_usage({"esc"}, HasSubstr("list, run, calibrate, stop"));
}

TEST(CmdEsc, ABoardFileNamesItsLines) {
  test::ScratchFolder folder;
  const auto board = [&](const std::string& esc) {
    return folder.write("board.toml", "[board]\nname = \"bench\"\n" + esc);
  };
  const std::string good = board(R"([esc]
output = "emulated"
frequency_hz = 400
protocol = "oneshot125"
motor = [{ name = "left", channel = 0 }, { name = "right", channel = 3 }]
most_throttle = 0.3
)");
  const auto list = lines_of(run_program({"esc", "list", "--board", good, "--json"}).out);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0]["protocol"], "OneShot125");
  EXPECT_EQ(list[0]["motors"][1]["channel"], 3);
  const ProgramResult run = run_program({"esc", "run", "--board", good, "--arm", "--props-off", kSentence,
                                         "--motor", "right", "--throttle", "0.2", "--hold", "1"});
  EXPECT_EQ(run.exit_code, 0) << run.err;

  const auto chip =
      lines_of(run_program({"esc", "list", "--json", "--board",
                            board("[esc]\noutput = \"pca9685\"\nbus = \"/dev/i2c-7\"\naddress = 0x41\n")})
                   .out);
  ASSERT_EQ(chip.size(), 1U);
  EXPECT_EQ(chip[0]["output"], "pca9685 0x41 on /dev/i2c-7");
  expect_usage({"esc", "list", "--board",
                board("[esc]\noutput = \"pca9685\"\nmotor = [{ name = \"left\", channel = 16 }]\n")},
               HasSubstr("channels 0 to 15"));
  expect_usage({"esc", "list", "--board", board("")}, HasSubstr("[esc]"));
  expect_usage({"esc", "list", "--board", board("[esc]\nfrequency_hz = 500\n")}, HasSubstr("490 Hz"));
  expect_usage({"esc", "list", "--board", board("[esc]\nidle_us = 1450\n")}, HasSubstr("calibrate"));
  expect_usage({"esc", "list", "--board",
                board("[esc]\nmotor = [{ name = \"a\", channel = 1 }, { name = "
                      "\"b\", channel = 1 }]\n")},
               HasSubstr("twice"));
  expect_usage({"esc", "list", "--board", board("[esc]\nthrotle = 1\n")}, HasSubstr("throtle"));
}

// Between two pulses that are the same nothing is written: only the stop finds the output gone.
TEST(CmdEsc, AStopThatFailsIsAFailure) {
  const test::SysfsTree tree;
  const std::string board = tree.folder().write(
      "escs.toml", "[board]\nname = \"bench\"\nguard_timeout_ms = 10000\n[esc]\nchip = \"" + tree.chip() +
                       "\"\nmotor = [{ name = \"left\", channel = 0 }]\n");
  Program program({"esc", "run", "--arm", "--props-off", kSentence, "--throttle", "0", "--hold", "1",
                   "--connect-within", "0", "--board", board});
  ASSERT_TRUE(program.wait_for_out("arming -> armed", 20s)) << program.so_far().err;
  std::filesystem::remove(tree.chip() + "/pwm0/duty_cycle");
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_THAT(result.err, HasSubstr("pwm0/duty_cycle"));
}

TEST(CmdEsc, ARealBoardThatIsNotThereSaysSo) {
  test::ScratchFolder folder;
  const std::string board = folder.write("board.toml", R"([board]
name = "bench"
[esc]
chip = "pwmchip987"
)");
  const ProgramResult list = run_program({"esc", "list", "--board", board});
  EXPECT_EQ(list.exit_code, 0) << "nothing is opened to list";
  const ProgramResult stop = run_program({"esc", "stop", "--board", board});
  EXPECT_EQ(stop.exit_code, 3);
  EXPECT_THAT(stop.err, HasSubstr("pwmchip987"));
  expect_usage({"esc", "calibrate", "--board", board, "--arm", "--props-off", kSentence},
               HasSubstr("--battery-off"));
}

}  // namespace
}  // namespace forager::tools
