// `forager bench overhead` from outside. How large a ratio is depends on the machine and is no business of a
// test.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/fake_machine.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

std::map<std::string, nlohmann::json> rows_of(const ProgramResult& result) {
  std::map<std::string, nlohmann::json> rows;
  for (const auto& row : lines_of(result.out)) rows[row["name"]] = row;
  return rows;
}

void expect_figures(const nlohmann::json& row) {
  SCOPED_TRACE(row.dump());
  ASSERT_TRUE(row.contains("ratio"));
  EXPECT_GT(row["time_ns"], 0.0);
  EXPECT_GT(row["bare_ns"], 0.0);
  EXPECT_GE(row["pairs"], 21);
  EXPECT_LE(row["ratio_low"], row["ratio"]);
  EXPECT_LE(row["ratio"], row["ratio_high"]);
  EXPECT_LE(row["ratio_p5"], row["ratio"]);
  EXPECT_LE(row["ratio"], row["ratio_p95"]);
}

TEST(BenchOverhead, MeasuresWhatNeedsNoHardwareAndSaysWhatTheRestNeeds) {
  const ProgramResult result = run_program({"bench", "overhead", "--seconds", "0.05", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  auto rows = rows_of(result);
  EXPECT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows["GPIO set"]["skipped"], "needs a free line: --gpio CHIP/LINE --arm");
  EXPECT_THAT(rows["I2C transfer"]["skipped"], HasSubstr("--i2c BUS@ADDRESS"));
  EXPECT_THAT(rows["USB"]["skipped"], HasSubstr("--usb VID:PID --arm"));
  expect_figures(rows["I2C transfer over nothing"]);
  if (built_with("libmodbus"))
    expect_figures(rows["Modbus round trip"]);
  else
    EXPECT_THAT(rows["Modbus round trip"]["skipped"], HasSubstr("libmodbus-dev"));
}

TEST(BenchOverhead, ALineIsToggledBothWaysAndEndsInactive) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  const test::ScratchFolder folder;
  std::filesystem::create_directory(folder.file("levels"));
  const ProgramResult result = run_program(
      {"bench", "overhead", "--seconds", "0.05", "--json", "--gpio", "pinctrl-bcm2711/GPIO17", "--arm"},
      FakeMachine{.root = folder.path()}.options());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(folder.read("levels/GPIO17"), "0");
  auto row = rows_of(result)["GPIO set"];
  expect_figures(row);
  EXPECT_EQ(row["ours"], "DigitalOut::set");
  EXPECT_THAT(row["bare"], testing::StartsWith("libgpiod "));
}

TEST(BenchOverhead, WhatWasAskedForAndFailsIsTheExitCodeAndTheRestIsMeasured) {
  if (!built_with("libgpiod")) GTEST_SKIP() << "built without libgpiod";
  const auto asked = [](const std::string& line, int exit_code, const char* says) {
    const ProgramResult result =
        run_program({"bench", "overhead", "--seconds", "0.02", "--json", "--gpio", line, "--arm"},
                    FakeMachine{}.options());
    EXPECT_EQ(result.exit_code, exit_code) << line;
    EXPECT_THAT(result.err, HasSubstr(says));
    auto rows = rows_of(result);
    EXPECT_THAT(rows["GPIO set"]["skipped"], HasSubstr(says));
    expect_figures(rows["I2C transfer over nothing"]);
  };
  asked("gpiochip0/GPIO22", 1, "\"spi0 CS1\" holds the line");
  asked("gpiochip0/GPIO99", 3, "the chip has no line of this name");
}

TEST(BenchOverhead, NothingIsDrivenWithoutArmOrWithAMistake) {
  expect_refusals(
      {{{"bench", "overhead", "--gpio", "gpiochip0/5"}, 2, "gpiochip0/5 would be toggled for 2 s"},
       {{"bench", "overhead", "--usb", "0403:6001"}, 2, "nothing is driven without --arm"},
       {{"bench", "overhead", "--usb", "ftdi", "--arm"}, 2, "no VID:PID"},
       {{"bench", "overhead", "--seconds", "0"}, 2, "--seconds"}});
}

TEST(BenchOverhead, TheTableIsForPeople) {
  const ProgramResult result = run_program({"bench", "overhead", "--seconds", "0.02"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("ratio (95 % confidence)"));
  EXPECT_THAT(result.out, HasSubstr("GPIO set                     skipped: needs a free line"));
  EXPECT_THAT(result.out, HasSubstr("call of an empty system call, "));
}

}  // namespace
}  // namespace forager::tools
