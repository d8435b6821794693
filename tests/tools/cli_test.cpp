// The program from outside: what a person gets who asks wrongly. Every mistake is one line on stderr that
// says what, where and what to do; stdout stays empty, and nothing is written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "reader/inventory_store.hpp"
#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kScene = test::source_path("scenes/4A.toml");
constexpr int kUsage = 2;
constexpr int kUnavailable = 3;

constexpr const char* kSmall = R"([scene]
name = "small"
[reader]
session = "S0"
port = [{ port = 4, bearing_deg = 0.0 }]
[mission]
policy = "stigmergy"
)";

class CommandLine : public testing::Test {
 protected:
  ProgramResult run(std::vector<std::string> arguments) {
    ProgramOptions options;
    options.folder = folder_.path();
    return run_program(arguments, std::move(options));
  }
  // One line, on stderr alone.
  void expect_refusal(const std::vector<std::string>& arguments, int exit_code,
                      const testing::Matcher<const std::string&>& says) {
    const ProgramResult result = run(arguments);
    SCOPED_TRACE(testing::PrintToString(arguments));
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, AllOf(StartsWith("forager: "), says));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("out"))) << "a run that never started left files";
  }
  std::string scene(const std::string& text) { return folder_.write("scene.toml", text); }

  test::ScratchFolder folder_;
};

TEST_F(CommandLine, SaysWhichCommandsThereAre) {
  expect_refusal({}, kUsage, AllOf(HasSubstr("a command is missing"), HasSubstr("run, report")));
  expect_refusal({"fly"}, kUsage, AllOf(HasSubstr("'fly' is not a command"), HasSubstr("run, report")));
  expect_refusal({"emulate", "toaster"}, kUsage, HasSubstr("'toaster' is not a command"));
}

TEST_F(CommandLine, SaysWhereHelpIs) {
  expect_refusal({"run"}, kUsage, AllOf(HasSubstr("scene is required"), HasSubstr("'forager run --help'")));
  expect_refusal({"report"}, kUsage, HasSubstr("'forager report --help'"));
  expect_refusal({"run", kScene, "--fast"}, kUsage, HasSubstr("--fast"));
  expect_refusal({"run", kScene, "more"}, kUsage, HasSubstr("more"));
}

TEST_F(CommandLine, HelpAndVersionAreResults) {
  const ProgramResult version = run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+\n"));
  EXPECT_EQ(version.err, "");
  const ProgramResult help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, AllOf(HasSubstr("run "), HasSubstr("report "), HasSubstr("Exit codes: 0 done")));
  EXPECT_EQ(help.err, "");
  const ProgramResult of_run = run({"run", "--help"});
  EXPECT_EQ(of_run.exit_code, 0);
  for (const char* option : {"--board", "--seed", "--policy", "--output", "--real-time", "--speed", "--json"})
    EXPECT_THAT(of_run.out, HasSubstr(option));
}

TEST_F(CommandLine, RefusesFilesThatAreNoScene) {
  expect_refusal({"run", "nowhere.toml"}, kUnavailable,
                 AllOf(HasSubstr("nowhere.toml"), HasSubstr("No such file")));
  expect_refusal({"run", folder_.path()}, kUnavailable, HasSubstr("It is a folder"));
  expect_refusal({"run", scene("x = = 1")}, kUsage,
                 AllOf(HasSubstr("scene.toml: line 1, column 5"), HasSubstr("TOML")));
  expect_refusal({"run", scene("")}, kUsage,
                 AllOf(HasSubstr("scene.toml"), HasSubstr("[scene] name: is missing")));
}

TEST_F(CommandLine, NamesFileLineKeyAndWhatIsAllowed) {
  const std::string small = kSmall;
  expect_refusal({"run", scene(small + "windw_s = 2\n")}, kUsage,
                 AllOf(HasSubstr("scene.toml:8: mission.windw_s"), HasSubstr("Did you mean 'window_s'?")));
  expect_refusal(
      {"run", scene(small + "window_s = -2\n")}, kUsage,
      AllOf(HasSubstr("scene.toml:8: [mission] window_s: is -2"), HasSubstr("Allowed: 0.1 to 60.")));
  expect_refusal({"run", scene(small + "tries = \"many\"\n")}, kUsage,
                 AllOf(HasSubstr("[mission] tries: is a string"), HasSubstr("whole numbers, 1 to 1000")));
  expect_refusal({"run", scene("[scene]\nname = \"../x\"\n")}, kUsage,
                 AllOf(HasSubstr("[scene] name"), HasSubstr("letters, digits")));
}

TEST_F(CommandLine, RefusesPortsWithoutBearingOrTwice) {
  const std::string head =
      "[scene]\nname = \"x\"\n[mission]\npolicy = \"stigmergy\"\n[reader]\nsession = \"S0\"\n";
  expect_refusal({"run", scene(head + "port = [{ port = 4 }]\n")}, kUsage,
                 AllOf(HasSubstr("bearing_deg: is missing"), HasSubstr("scene.toml:7")));
  expect_refusal(
      {"run", scene(head + "port = [{ port = 4, bearing_deg = 0 }, { port = 4, bearing_deg = 90 }]\n")},
      kUsage, AllOf(HasSubstr("scene.toml"), HasSubstr("port"), HasSubstr("4")));
}

TEST_F(CommandLine, RefusesPoliciesThatCannotBe) {
  expect_refusal(
      {"run", kScene, "--policy", "guess"}, kUsage,
      AllOf(HasSubstr("\"guess\" is not a policy"), HasSubstr("stigmergy, static, dead_reckoning")));
  expect_refusal({"run", scene(kSmall), "--policy", "dead_reckoning"}, kUsage, HasSubstr("waypoints"));
  for (const char* endless : {"static", "random_walk"})
    expect_refusal({"run", scene(kSmall), "--policy", endless}, kUsage, HasSubstr("time_limit_s"));
}

TEST_F(CommandLine, TakesNumbersStrictly) {
  for (const char* seed : {"abc", "5x", "-1", "+1", "1.5", "0x10", "", " 1", "99999999999999999999999"})
    expect_refusal({"run", kScene, "--seed", seed}, kUsage,
                   AllOf(HasSubstr("--seed"), HasSubstr("whole number")));
  for (const char* evaluations : {"0", "100001", "4294967297"})
    expect_refusal({"calibrate", "--published", "--evaluations", evaluations}, kUsage,
                   AllOf(HasSubstr("--evaluations"), HasSubstr("from 1 to 100000")));
  for (const char* port : {"-1", "0x50", "65536", ""})
    expect_refusal({"emulate", "reader", kScene, "--for", "0.01", "--rest-port", port}, kUsage,
                   HasSubstr("--rest-port"));
  for (const char* speed : {"0", "-1", "nan", "inf", "fast", "2x", "1e9"})
    expect_refusal({"run", kScene, "--speed", speed}, kUsage,
                   AllOf(HasSubstr("--speed"), HasSubstr("from 0.01 to 1000")));
}

TEST_F(CommandLine, RefusesBoardsThatCannotBe) {
  const auto board = [this](const std::string& text) {
    return folder_.write("board.toml", "[board]\nname = \"b\"\n" + text);
  };
  expect_refusal({"run", kScene, "--board", "nowhere.toml"}, kUnavailable, HasSubstr("nowhere.toml"));
  expect_refusal({"run", kScene, "--board", board("knd = \"sim\"\n")}, kUsage,
                 AllOf(HasSubstr("board.toml:3: board.knd"), HasSubstr("'kind'")));
  expect_refusal({"run", kScene, "--board", board("[autopilot]\naddress = \"drone\"\n")}, kUsage,
                 AllOf(HasSubstr("board.toml:4"), HasSubstr("is not HOST:PORT")));
  expect_refusal({"run", kScene, "--board", board("[reader]\nuser = \"u\"\n")}, kUsage,
                 HasSubstr("password_env"));
  expect_refusal(
      {"run", kScene, "--board", board("[reader]\nuser = \"u\"\npassword_env = \"FORAGER_NOT_SET\"\n")},
      kUnavailable, HasSubstr("FORAGER_NOT_SET is not set"));
}

TEST_F(CommandLine, SaysWhenItCannotWrite) {
  const std::string file = folder_.write("file", "");
  expect_refusal({"run", kScene, "--output", file + "/below"}, kUnavailable,
                 AllOf(HasSubstr("file/below: create output folder"), HasSubstr("--output")));
  expect_refusal({"run", kScene, "--output", file}, kUnavailable, HasSubstr("--output"));
}

TEST_F(CommandLine, ReportsOnInventoriesOnly) {
  if (!reader::have_sqlite_inventory()) GTEST_SKIP() << "built without SQLite";
  expect_refusal({"report", "nowhere.sqlite"}, kUnavailable,
                 AllOf(HasSubstr("nowhere.sqlite"), HasSubstr("there is no such file")));
  expect_refusal({"report", folder_.write("notes.txt", "not an inventory, whatever its name")}, 1,
                 AllOf(HasSubstr("notes.txt"), HasSubstr("not a database"),
                       HasSubstr("Name a file that forager wrote")));
  expect_refusal({"report", folder_.path()}, kUnavailable, HasSubstr("inventory.sqlite"));
}

}  // namespace
}  // namespace forager::tools
