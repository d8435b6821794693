// `forager selftest` from outside, on emulated pins and on libgpiod over a fake kernel.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/fake_machine.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

ProgramResult on_pins(const std::vector<std::string>& arguments, const std::string& gpio = {}) {
  return run_program(arguments, FakeMachine{.gpio = gpio}.options());
}

class CmdSelftest : public testing::Test {
 protected:
  void SetUp() override {
    if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  }
};

TEST_F(CmdSelftest, TwoWiredPinsGiveEveryEdge) {
  const ProgramResult sim =
      run_program({"selftest", "--board", "sim", "--out", "sim/OUT2", "--in", "sim/IN2", "--arm"});
  EXPECT_EQ(sim.exit_code, 0) << sim.err;
  EXPECT_EQ(
      sim.out,
      "sim/OUT2 to sim/IN2: 100 toggles, 100 edges, 0 extra; from set to edge 0.0 us p50, 0.0 us p99, 0.0 us "
      "max\n");
  const ProgramResult pins = on_pins(
      {"selftest", "--out", "gpiochip0/17", "--in", "gpiochip0/27", "--arm", "--count", "20", "--json"});
  EXPECT_EQ(pins.exit_code, 0) << pins.err;
  EXPECT_EQ(nlohmann::json::parse(pins.out)["edges"], 20);
  EXPECT_GT(nlohmann::json::parse(pins.out)["latency_max_us"], 0.0);
}

TEST_F(CmdSelftest, AWireThatIsOffFailsTheCheck) {
  const ProgramResult off =
      on_pins({"selftest", "--out", "gpiochip0/17", "--in", "gpiochip0/27", "--arm"}, "loose");
  EXPECT_EQ(off.exit_code, 4);
  EXPECT_EQ(off.err,
            "forager: gpiochip0/17 to gpiochip0/27: no edge came: the two pins are not wired together\n");
  const ProgramResult other =
      run_program({"selftest", "--board", "sim", "--out", "sim/OUT2", "--in", "sim/IN3", "--arm"});
  EXPECT_EQ(other.exit_code, 4);
  const ProgramResult unsaid = run_program({"selftest", "--out", "gpiochip0/17"});
  EXPECT_EQ(unsaid.exit_code, 2);
  EXPECT_THAT(unsaid.err, HasSubstr("--out LINE --in LINE, or --serial PORT"));
}

}  // namespace
}  // namespace forager::tools
