// The program from outside: what a run prints and leaves behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "reader/inventory_store.hpp"
#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

const std::string kScenes = test::source_path("scenes/");
const std::string kScene = kScenes + "4A.toml";

std::vector<json> lines_of(const std::string& out) {
  std::vector<json> lines;
  std::istringstream in(out);
  for (std::string line; std::getline(in, line);) {
    json parsed = json::parse(line, nullptr, false);
    EXPECT_TRUE(parsed.is_object()) << "not a JSON object: " << line;
    lines.push_back(std::move(parsed));
  }
  return lines;
}

double number_after(const std::string& text, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(pattern))) return std::nan("");
  return std::stod(match[1]);
}

class RunCommandLine : public testing::Test {
 protected:
  std::vector<std::string> flown(std::vector<std::string> more = {}, const std::string& scene = kScene) {
    std::vector<std::string> arguments{"run", scene, "--output", folder_.file("run")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  test::ScratchFolder folder_;
};

TEST_F(RunCommandLine, JsonIsLinesAndTheLastIsTheSummary) {
  const ProgramResult result = run_program(flown({"--json", "--seed", "3"}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const auto lines = lines_of(result.out);
  ASSERT_GT(lines.size(), 10U);
  for (const json& line : lines) EXPECT_TRUE(line.contains("event")) << line;
  const json& summary = lines.back();
  EXPECT_EQ(summary["event"], "summary");
  EXPECT_EQ(summary["scene"], "4A");
  EXPECT_EQ(summary["policy"], "stigmergy");
  EXPECT_EQ(summary["seed"], 3);
  EXPECT_EQ(summary["board"], "sim");
  EXPECT_EQ(summary["tags_present"], 300);
  EXPECT_GT(summary["tags_read"], 0);
  EXPECT_LE(summary["tags_read"], 300);
  EXPECT_GE(summary["reads"], summary["tags_read"]);
  EXPECT_GT(summary["path_m"], 0.0);
  EXPECT_GT(summary["decisions"], 0);
  EXPECT_EQ(summary["end_reason"], "no_new_tags");
  EXPECT_GT(summary["sim_time_s"], summary["flight_time_s"]);
  EXPECT_GT(summary["wall_time_s"], 0.0);
  std::size_t decisions = 0;
  for (const json& line : lines) decisions += line["event"] == "decision" ? 1U : 0U;
  EXPECT_EQ(summary["decisions"], decisions);
  double reads = 0.0;
  double new_tags = 0.0;
  for (const json& port : summary["ports"]) {
    reads += port["reads"].get<double>();
    new_tags += port["new_tags"].get<double>();
  }
  EXPECT_EQ(summary["reads"], reads);
  EXPECT_NEAR(summary["tags_read"].get<double>(), new_tags, 1e-6);
}

TEST_F(RunCommandLine, TheTableSaysWhatTheJsonSays) {
  const ProgramResult table = run_program(flown());
  const json summary = lines_of(run_program(flown({"--json"})).out).back();
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_EQ(table.err, "");
  EXPECT_THAT(table.out, testing::StartsWith("4A - 300 tags"));
  EXPECT_EQ(number_after(table.out, "tags read +([0-9]+) of 300"), summary["tags_read"]);
  EXPECT_EQ(number_after(table.out, "reads +([0-9]+) "), summary["reads"]);
  EXPECT_NEAR(number_after(table.out, "time +([0-9.]+) s"), summary["sim_time_s"].get<double>(), 0.05001);
  EXPECT_NEAR(number_after(table.out, "path +([0-9.]+) m"), summary["path_m"].get<double>(), 0.05001);
  EXPECT_EQ(number_after(table.out, ", ([0-9]+) decisions"), summary["decisions"]);
  EXPECT_EQ(number_after(table.out, "decisions in ([0-9]+) windows"), summary["windows"]);
  EXPECT_THAT(table.out, HasSubstr(summary["end_reason"].get<std::string>()));
  EXPECT_THAT(table.out, HasSubstr("run/report.html"));
}

TEST_F(RunCommandLine, TheSameSeedGivesTheSameRunAndAnotherSeedAnother) {
  const auto run = [this](const std::string& seed, const std::string& folder) {
    const ProgramResult result =
        run_program({"run", kScene, "--json", "--wire", "--seed", seed, "--output", folder_.file(folder)});
    json summary = lines_of(result.out).back();
    summary.erase("wall_time_s");
    return summary;
  };
  const json first = run("11", "a");
  EXPECT_EQ(first, run("11", "b"));
  EXPECT_NE(first, run("12", "c"));
  const std::string journal = folder_.read("a/journal.txt");
  EXPECT_GT(journal.size(), 100'000U);
  EXPECT_TRUE(journal == folder_.read("b/journal.txt")) << "journals differ";
  EXPECT_FALSE(journal == folder_.read("c/journal.txt"));
}

TEST_F(RunCommandLine, TheReportIsOnePageThatLoadsNothing) {
  const json summary = lines_of(run_program(flown({"--json"})).out).back();
  const std::string page = folder_.read("run/report.html");
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  for (const std::string& part :
       {std::string("<title>4A"), summary["tags_read"].dump() + " <small>of 300", std::string("no_new_tags")})
    EXPECT_TRUE(page.find(part) != std::string::npos) << "not on the page: " << part;
  EXPECT_TRUE(page.find("<script") == std::string::npos);
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href|action)=\"?(https?:)?//"))) << "loads something";
  EXPECT_FALSE(std::regex_search(page, std::regex("url\\(|@import")));
}

TEST_F(RunCommandLine, TheInventoryIsReportedOn) {
  if (!reader::have_sqlite_inventory()) GTEST_SKIP() << "built without SQLite";
  const json summary = lines_of(run_program(flown({"--json"})).out).back();
  for (const char* name : {"run/inventory.sqlite", "run"}) {
    const ProgramResult report = run_program({"report", folder_.file(name), "--json", "--items"});
    EXPECT_EQ(report.exit_code, 0);
    EXPECT_EQ(report.err, "");
    const auto lines = lines_of(report.out);
    EXPECT_EQ(lines.front()["items"], summary["tags_read"]);
    EXPECT_EQ(lines.front()["reads"], summary["reads"]);
    EXPECT_EQ(lines.front()["facts"]["end_reason"], summary["end_reason"]);
    EXPECT_EQ(lines.size(), 1 + summary["tags_read"].get<std::size_t>());
  }
  const ProgramResult csv = run_program({"report", folder_.file("run"), "--csv", "-"});
  EXPECT_EQ(std::count(csv.out.begin(), csv.out.end(), '\n'), 1 + summary["tags_read"].get<int>());
}

TEST_F(RunCommandLine, WritesNothingWhenAskedTo) {
  ProgramOptions options;
  options.folder = folder_.path();
  const ProgramResult result = run_program({"run", kScene, "--no-files"}, options);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(folder_.empty());
}

TEST_F(RunCommandLine, AnInventoryOfARealPlaceIsNeverOverwritten) {
  if (!reader::have_sqlite_inventory()) GTEST_SKIP() << "built without SQLite";
  ASSERT_EQ(run_program(flown()).exit_code, 0);
  const std::string before = folder_.read("run/inventory.sqlite");
  const std::string board = folder_.write("board.toml", "[board]\nname = \"drone\"\n");
  const ProgramResult result = run_program(flown({"--board", board}));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("never overwritten"));
  EXPECT_TRUE(before == folder_.read("run/inventory.sqlite"));
}

TEST_F(RunCommandLine, SaysOnStderrWhyNothingFlew) {
  if (!reader::have_sqlite_inventory()) GTEST_SKIP() << "built without SQLite";
  const std::string scene =
      folder_.write("hasty.toml", "base = \"" + kScene + "\"\n[links]\nstart_timeout_s = 1\n");
  const std::string board = folder_.write("board.toml",
                                          "[board]\nname = \"nobody\"\n"
                                          "[reader]\nrest_port = 9\nstream_port = 9\n"
                                          "[autopilot]\naddress = \"127.0.0.1:9\"\n"
                                          "[world]\ntruth = \"127.0.0.1:45871\"\n");
  const ProgramResult result = run_program(flown({"--json", "--board", board, "--speed", "5"}, scene));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err,
              testing::AllOf(testing::StartsWith("forager: mission 4A: autopilot_lost: no heartbeat"),
                             HasSubstr("Check the autopilot's power")));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  const json summary = lines_of(result.out).back();
  EXPECT_EQ(summary["end_reason"], "autopilot_lost");
  EXPECT_EQ(summary["flight_time_s"], 0.0);
  EXPECT_TRUE(folder_.has("run/report.html"));
}

TEST_F(RunCommandLine, EveryPolicyFlies) {
  const std::string scene = folder_.write("all.toml", "base = \"" + kScenes +
                                                          "3C.toml\"\n[mission]\ntime_limit_s = 60\n"
                                                          "waypoints = [[4.0, 0.0]]\n");
  for (const char* policy : {"stigmergy", "static", "dead_reckoning", "stop_and_rotate", "random_walk"}) {
    SCOPED_TRACE(policy);
    const ProgramResult result = run_program(flown({"--json", "--policy", policy}, scene));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json summary = lines_of(result.out).back();
    EXPECT_EQ(summary["policy"], policy);
    EXPECT_GT(summary["tags_read"], 50);
    EXPECT_EQ(summary["crashes"], 0);
    EXPECT_LT(summary["flight_time_s"], 90.0);
    if (std::string(policy) == "static") {
      EXPECT_LT(summary["path_m"], 0.5);
    }
    if (std::string(policy) == "dead_reckoning") {
      EXPECT_NEAR(summary["path_m"].get<double>(), 4.0, 0.5);
    }
  }
}

TEST_F(RunCommandLine, GoesOnWhenNobodyReadsItsOutput) {
  for (const bool json_lines : {false, true}) {
    ProgramOptions options;
    options.closed_stdout = true;
    const ProgramResult result = run_program(
        flown(json_lines ? std::vector<std::string>{"--json"} : std::vector<std::string>{}), options);
    EXPECT_EQ(result.signal, 0);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("stdout"));
    EXPECT_THAT(folder_.read("run/journal.txt"), HasSubstr("phase done"));
    EXPECT_TRUE(folder_.has("run/report.html"));
  }
}

// In real time, twenty times as fast: a mission of minutes that a signal must end early.
class InterruptedRun : public RunCommandLine {
 protected:
  Program start(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--json", "--speed", "20"});
    return Program(flown(std::move(more)));
  }
};

TEST_F(InterruptedRun, ASignalLandsAndTheReportIsWritten) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    SCOPED_TRACE(number);
    Program program = start();
    ASSERT_TRUE(program.wait_for_out("\"event\":\"decision\"", 20s));
    program.send_signal(number);
    const ProgramResult result = program.finish();
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.err, testing::AllOf(testing::StartsWith("forager: SIG"), HasSubstr("landing")));
    const json summary = lines_of(result.out).back();
    EXPECT_EQ(summary["end_reason"], "halted");
    EXPECT_EQ(summary["crashes"], 0);
    EXPECT_THAT(folder_.read("run/journal.txt"), HasSubstr("phase done"));
    EXPECT_THAT(folder_.read("run/journal.txt"), HasSubstr("/stop -> OK")) << "the reader was told to stop";
    EXPECT_THAT(folder_.read("run/report.html"), HasSubstr("halted"));
  }
}

TEST_F(InterruptedRun, ASecondSignalEndsItAtOnce) {
  Program program = start();
  ASSERT_TRUE(program.wait_for_out("\"event\":\"decision\"", 20s));
  program.send_signal(SIGINT);
  ASSERT_TRUE(program.wait_for_err("once more ends the program", 5s));
  program.send_signal(SIGINT);
  const ProgramResult result = program.finish();
  EXPECT_EQ(result.signal, SIGINT);
  EXPECT_FALSE(result.timed_out);
}

}  // namespace
}  // namespace forager::tools
