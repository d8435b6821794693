// `forager doctor` from outside: what is told of the machine itself, and in which form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/doctor_rig.hpp"

namespace forager::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(CmdDoctor, JsonHasEveryCheckAndASummary) {
  const ProgramResult result = run_program({"doctor", "--json", board(kButton)}, FakeMachine{}.options());
  EXPECT_EQ(result.exit_code, 0);
  std::istringstream in(result.out);
  nlohmann::json last;
  int checks = 0;
  for (std::string line; std::getline(in, line);) {
    last = nlohmann::json::parse(line);
    checks += last["event"] == "check" ? 1 : 0;
  }
  EXPECT_EQ(last["event"], "summary");
  EXPECT_EQ(checks, last["ok"].get<int>() + last["warned"].get<int>() + last["skipped"].get<int>() +
                        last["failed"].get<int>());
}

TEST_F(CmdDoctor, AMistakeInTheBoardIsUsage) {
  const ProgramResult result =
      run_program({"doctor", board("[[gpio]]\nname = \"a\"\nchip = \"b\"\nlin = \"c\"\n")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("robot.toml"));
  EXPECT_EQ(run_program({"doctor", "/nowhere/board.toml"}).exit_code, 3);
}

TEST_F(CmdDoctor, APiThatStarvesIsToldSo) {
  FakeMachine machine{.root = folder_.path()};
  std::filesystem::create_directories(folder_.file("proc/device-tree"));
  std::filesystem::create_directories(folder_.file("sys/devices/platform/soc/soc:firmware"));
  std::filesystem::create_directories(folder_.file("sys/bus/hid/devices/0003:04D8:00DD.0001"));
  std::filesystem::create_directories(folder_.file("sys/bus/hid/drivers/mcp2221"));
  std::filesystem::create_directories(folder_.file("sys/kernel"));
  std::filesystem::create_symlink("../../drivers/mcp2221",
                                  folder_.file("sys/bus/hid/devices/0003:04D8:00DD.0001/driver"));
  folder_.write("proc/device-tree/model", "Raspberry Pi 4 Model B Rev 1.4");
  folder_.write("sys/devices/platform/soc/soc:firmware/get_throttled", "50005\n");
  folder_.write("sys/kernel/realtime", "1\n");
  const ProgramResult result = run_program({"doctor"}, machine.options());
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(
      told(result.out, "supply"),
      AllOf(HasSubstr("failed   host     supply: right now: under-voltage, throttled"), HasSubstr("5.1 V")));
  EXPECT_THAT(told(result.out, "real time"),
              HasSubstr("ok       host     real time: the kernel is PREEMPT_RT"));
  EXPECT_THAT(
      told(result.out, "mcp2221"),
      AllOf(HasSubstr("failed   machine  mcp2221: the kernel's driver hid-mcp2221 holds the USB bridge"),
            HasSubstr("blacklist hid_mcp2221")));
}

}  // namespace
}  // namespace forager::tools
