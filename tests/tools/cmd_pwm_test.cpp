// `forager pwm`, `forager servo` and `forager i2c` from outside, on an emulated machine and on hardware this
// one does not have.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

ProgramResult on_sim(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--board", "sim"});
  return run_program(arguments);
}

std::vector<nlohmann::json> events(const std::string& out, const std::string& kind) {
  std::vector<nlohmann::json> found;
  std::istringstream in(out);
  for (std::string line; std::getline(in, line);)
    if (auto event = nlohmann::json::parse(line); event["event"] == kind) found.push_back(event);
  return found;
}

void expect_usage(const ProgramResult& result, const char* says) {
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, AllOf(StartsWith("forager: "), HasSubstr(says)));
}

TEST(CmdPwm, SetMakesPulsesForItsTimeAndNoneAfterwards) {
  const ProgramResult result = on_sim({"pwm", "set", "sim/0", "--us", "1500", "--hold", "2s", "--arm"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "sim/0: 1500 us for 2 s, every 20000 us\n"
            "sim/0: no pulses any more; the last were 1500.0 us long\n");
}

TEST(CmdPwm, SweepGoesThereAndBack) {
  const ProgramResult result = on_sim({"pwm", "sweep", "sim/1", "--from", "1000", "--to", "2000", "--over",
                                       "1s", "--frequency", "100", "--arm", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto pulses = events(result.out, "pulse");
  ASSERT_GT(pulses.size(), 150U);
  double longest = 0.0;
  double longest_at = 0.0;
  for (const auto& pulse : pulses)
    if (pulse["pulse_us"] > longest) {
      longest = pulse["pulse_us"];
      longest_at = pulse["t_s"];
    }
  EXPECT_NEAR(longest, 2000.0, 1.0);
  EXPECT_NEAR(longest_at - pulses.front()["t_s"].get<double>(), 1.0, 0.02);
  EXPECT_NEAR(pulses.back()["pulse_us"].get<double>(), 1000.0, 1.0);
}

TEST(CmdPwm, MistakesDriveNothing) {
  expect_usage(on_sim({"pwm", "set", "sim/0", "--us", "1500", "--hold", "2s"}),
               "nothing is driven without --arm: sim/0 would make pulses of 1500 us for 2 s");
  expect_usage(on_sim({"pwm", "set", "sim/0", "--us", "30000", "--hold", "1", "--arm"}),
               "longer than the period");
  expect_usage(on_sim({"pwm", "set", "tilt", "--us", "1500", "--hold", "1", "--arm"}), "is neither a servo");
  expect_usage(on_sim({"pwm", "set", "sim/0", "--hold", "1", "--arm"}), "--us");
  const ProgramResult absent =
      run_program({"pwm", "set", "pwmchip77/0", "--us", "1500", "--hold", "1", "--arm"});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_THAT(absent.err,
              AllOf(HasSubstr("pwm pwmchip77: open: there is no such PWM chip"), HasSubstr("dtoverlay")));
}

TEST(CmdPwm, CtrlCEndsThePulses) {
  Program program(
      {"pwm", "set", "sim/0", "--us", "1500", "--hold", "60s", "--arm", "--board", "sim", "--real-time"});
  ASSERT_TRUE(program.wait_for_out("for 60 s", 10s));
  program.send_signal(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("no pulses any more"));
}

class CmdServo : public testing::Test {
 protected:
  std::string board_ = folder().write("robot.toml", R"([board]
name = "robot"
[[servo]]
name = "tilt"
backend = "sim"
channel = 1
from_us = 1200
to_us = 1800
safe = 0.25
slew_per_s = 2
[brakes.left]
backend = "pca9685"
channel = 4
[brakes.right]
backend = "sysfs_pwm"
channel = 1
)");
  test::ScratchFolder& folder() {
    static test::ScratchFolder folder;
    return folder;
  }
};

TEST_F(CmdServo, ListNamesServosAndBrakesThatAreServos) {
  const ProgramResult result = run_program({"servo", "list", "--board", board_});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out,
            "tilt: sim/1, 1200 us to 1800 us, trim 0 us; safe at 0.25, held\n"
            "brakes.left: /dev/i2c-1@0x40/4, 1180 us to 1725 us, trim 0 us; safe at 1, held\n"
            "brakes.right: pwmchip0/1, 1180 us to 1875 us, trim 0 us; safe at 1, held\n");
}

TEST_F(CmdServo, SetGoesThereNoFasterThanItsSlewAndEndsSafe) {
  const ProgramResult result = on_sim({"servo", "set", "sim", "1", "--hold", "1s", "--arm", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto states = events(result.out, "state");
  ASSERT_GT(states.size(), 10U);
  for (std::size_t i = 1; i + 2 < states.size(); ++i) {
    const double step = states[i]["at"].get<double>() - states[i - 1]["at"].get<double>();
    const double time = states[i]["t_s"].get<double>() - states[i - 1]["t_s"].get<double>();
    if (states[i]["t_s"] > 0.99) break;  // from there on it is on its way back, without slew
    EXPECT_LE(step, 2.0 * time + 1e-6);
  }
  const auto furthest = std::max_element(states.begin(), states.end(),
                                         [](const auto& a, const auto& b) { return a["at"] < b["at"]; });
  EXPECT_EQ((*furthest)["pulse_us"], 2000.0);
  EXPECT_EQ(events(result.out, "end").front()["at"], 0.5);
}

TEST_F(CmdServo, SweepAndTrimEndAtTheSafePlace) {
  const ProgramResult sweep = on_sim({"servo", "sweep", "sim", "--over", "1s", "--arm"});
  EXPECT_EQ(sweep.exit_code, 0) << sweep.err;
  EXPECT_EQ(sweep.out, "sim: 0 to 1 and back within 2 s\nsim: safe at 0.5, held with 1500.0 us\n");
  const ProgramResult trim = on_sim({"servo", "trim", "sim", "--us", "-12", "--hold", "1s", "--arm"});
  EXPECT_EQ(trim.exit_code, 0) << trim.err;
  EXPECT_EQ(trim.out,
            "sim: 0.5 for 1 s\nsim: safe at 0.5, held with 1488.0 us\n"
            "to keep it, write into the board file: trim_us = -12\n");
}

TEST_F(CmdServo, NothingMovesWithoutArmOrBeyondItsTravel) {
  expect_usage(on_sim({"servo", "set", "sim", "1", "--hold", "1s"}),
               "nothing is driven without --arm: sim would go to 1 for 1 s");
  expect_usage(on_sim({"servo", "set", "sim", "1.1", "--hold", "1s", "--arm"}), "1.1");
  expect_usage(run_program({"servo", "set", "pan", "1", "--hold", "1s", "--arm", "--board", board_}),
               "there is no servo of this name. The board file names tilt, brakes.left, brakes.right");
  expect_usage(run_program({"servo", "list"}), "[[servo]]");
}

TEST(CmdI2c, ScanReadAndWrite) {
  const ProgramResult scan = on_sim({"i2c", "scan"});
  EXPECT_EQ(scan.exit_code, 0) << scan.err;
  EXPECT_EQ(scan.out, "0x40 answers\n1 chip on sim\n");
  const ProgramResult read = on_sim({"i2c", "read", "sim@0x40", "--register", "0", "--count", "2"});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  EXPECT_EQ(read.out.substr(0, 16), "sim@0x40 from 0:");
  const ProgramResult write = on_sim({"i2c", "write", "sim@0x40", "0x02", "0xe2", "--arm", "--json"});
  EXPECT_EQ(write.exit_code, 0) << write.err;
  EXPECT_EQ(write.out, "{\"event\":\"written\",\"chip\":\"sim@0x40\",\"count\":2}\n");
}

TEST(CmdI2c, SaysWhatIsWrong) {
  const ProgramResult unplugged = on_sim({"i2c", "read", "sim@0x41"});
  EXPECT_EQ(unplugged.exit_code, 1);
  EXPECT_EQ(unplugged.err, "forager: i2c sim: transfer with 0x41: no chip answers at this address\n");
  const ProgramResult bus = run_program({"i2c", "scan", "77"});
  EXPECT_EQ(bus.exit_code, 3);
  EXPECT_THAT(bus.err,
              AllOf(HasSubstr("i2c /dev/i2c-77: open: there is no such bus"), HasSubstr("modprobe i2c-dev")));
  expect_usage(on_sim({"i2c", "write", "sim@0x40", "0x02"}),
               "nothing is driven without --arm: sim@0x40 would be written 0x02, and keep it");
  expect_usage(on_sim({"i2c", "write", "sim@0x40", "256", "--arm"}), "'256' is not a byte");
  expect_usage(on_sim({"i2c", "read", "sim@0x78"}), "addresses are 0x08 to 0x77");
}

}  // namespace
}  // namespace forager::tools
