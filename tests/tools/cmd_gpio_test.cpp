// `forager gpio` from outside, on emulated pins and on libgpiod over a fake kernel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/fake_machine.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

ProgramResult on_pins(const std::vector<std::string>& arguments, const std::string& gpio = {}) {
  return run_program(arguments, FakeMachine{.gpio = gpio}.options());
}

nlohmann::json last_line(const std::string& out) {
  nlohmann::json last;
  std::istringstream in(out);
  for (std::string line; std::getline(in, line);) last = nlohmann::json::parse(line);
  return last;
}

// On libgpiod over the fake kernel.
class CmdGpioOnPins : public testing::Test {
 protected:
  void SetUp() override {
    if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  }
  // With a guard that does not take a program for hung because the machine is busy.
  test::ScratchFolder folder_;
  std::string patient_ =
      folder_.write("patient.toml", "[board]\nname = \"patient\"\nguard_timeout_ms = 10000\n");
};

TEST_F(CmdGpioOnPins, ListSaysWhoHoldsALineAndWhatTheBoardCallsIt) {
  const test::ScratchFolder folder;
  const std::string board = folder.write(
      "robot.toml",
      "[board]\nname = \"robot\"\n[[gpio]]\nname = \"stop\"\nchip = \"pinctrl-bcm2711\"\nline = \"GPIO5\"\n");
  const ProgramResult result = on_pins({"gpio", "list", "--board", board});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(
      result.out,
      AllOf(StartsWith("gpiochip0 (pinctrl-bcm2711)   0 GPIO0            input  free\n"),
            HasSubstr("gpiochip0 (pinctrl-bcm2711)   5 GPIO5            input  free, here called stop\n"),
            HasSubstr("gpiochip0 (pinctrl-bcm2711)  22 GPIO22           input  held by \"spi0 CS1\"\n")));
  const ProgramResult none = on_pins({"gpio", "list", "--chip", "pinctrl-bcm2835"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_EQ(
      none.err,
      "forager: gpio pinctrl-bcm2835: list: there is no such chip. See what there is: forager gpio list\n");
}

TEST_F(CmdGpioOnPins, ReadGivesTheLevelOfNamesAndPlaces) {
  const ProgramResult result = on_pins({"gpio", "read", "gpiochip0/GPIO5", "pinctrl-bcm2711/6"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "gpiochip0/GPIO5: inactive\npinctrl-bcm2711/6: inactive\n");
  const ProgramResult pulled =
      on_pins({"gpio", "read", "gpiochip0/5", "--pull", "up", "--active-low", "--json"});
  EXPECT_EQ(pulled.out, "{\"event\":\"level\",\"name\":\"gpiochip0/5\",\"active\":false}\n");
}

TEST_F(CmdGpioOnPins, FaultsAreToldApart) {
  const auto refused = [](const std::string& line, const std::string& gpio, int exit_code, const char* says) {
    const ProgramResult result = on_pins({"gpio", "read", line}, gpio);
    EXPECT_EQ(result.exit_code, exit_code) << line;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(says));
  };
  refused("gpiochip0/GPIO22", "", 1, "gpio gpiochip0/GPIO22: open: \"spi0 CS1\" holds the line");
  refused("gpiochip0/GPIO99", "", 3, "the chip has no line of this name");
  refused("gpiochip9/GPIO5", "", 3, "gpio gpiochip9/GPIO5: open: ");
  refused("gpiochip0/GPIO5", "forbidden", 3, "99-forager.rules");
  refused("GPIO5", "", 2, "is neither a name of the board file nor CHIP/LINE");
}

TEST_F(CmdGpioOnPins, SetHoldsForItsTimeAndIsInactiveAfterwards) {
  const ProgramResult result =
      run_program({"gpio", "set", "sim/OUT1", "on", "--hold", "2s", "--arm", "--board", "sim"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "sim/OUT1: active for 2 s\nsim/OUT1: inactive\n");
  EXPECT_EQ(
      on_pins({"gpio", "set", "gpiochip0/17", "on", "--hold", "20ms", "--arm", "--board", patient_}).out,
      "gpiochip0/17: active for 0.02 s\ngpiochip0/17: inactive\n");
}

TEST(CmdGpio, NothingIsDrivenWithoutArmOrWithAMistake) {
  const auto refused = [](std::vector<std::string> rest, const char* says) {
    rest.insert(rest.begin(), {"gpio", "set", "--board", "sim"});
    const ProgramResult result = run_program(rest);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, AllOf(StartsWith("forager: "), HasSubstr(says)));
  };
  refused({"sim/OUT1", "on", "--hold", "2s"},
          "nothing is driven without --arm: sim/OUT1 would be active for 2 s");
  refused({"sim/OUT1", "on", "--arm"}, "--hold");
  refused({"sim/OUT1", "high", "--arm", "--hold", "1"}, "high");
  refused({"sim/OUT1", "on", "--arm", "--hold", "2x"}, "2x");
  refused({"sim/IN1", "on", "--arm", "--hold", "1"}, "is an input");
}

TEST_F(CmdGpioOnPins, CtrlCLeavesTheLineInactive) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Program program({"gpio", "set", "gpiochip0/17", "on", "--hold", "60s", "--arm", "--board", patient_},
                    FakeMachine{}.options());
    ASSERT_TRUE(program.wait_for_out("active for 60 s", 10s));
    program.send_signal(signal);
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.out, HasSubstr("gpiochip0/17: inactive\n"));
    EXPECT_THAT(result.err, HasSubstr("gpiochip0/17: ended by SIG"));
  }
}

TEST_F(CmdGpioOnPins, WatchEndsWithItsTimeOrACtrlC) {
  const ProgramResult timed = on_pins({"gpio", "watch", "gpiochip0/5", "--for", "30ms"});
  EXPECT_EQ(timed.exit_code, 0) << timed.err;
  EXPECT_EQ(timed.out, "gpiochip0/5: inactive\ngpiochip0/5: 0 edges, inactive at the end\n");
  Program watch({"gpio", "watch", "gpiochip0/5", "--json"}, FakeMachine{}.options());
  ASSERT_TRUE(watch.wait_for_out("\"level\"", 10s));
  watch.send_signal(SIGINT);
  const ProgramResult ended = watch.finish();
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_EQ(last_line(ended.out)["edges"], 0);
}

}  // namespace
}  // namespace forager::tools
