// `forager stress` and `forager bench accuracy` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

std::vector<nlohmann::json> rows_of(const std::string& text) {
  std::vector<nlohmann::json> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) rows.push_back(nlohmann::json::parse(line));
  return rows;
}

TEST(StressCommand, EveryCaseIsARowWithItsBound) {
  const ProgramResult result = run_program({"stress", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const auto rows = rows_of(result.out);
  EXPECT_GE(rows.size(), 25U);
  for (const auto& row : rows) {
    EXPECT_EQ(row.size(), 4U);
    EXPECT_TRUE(row["ok"].get<bool>()) << row.dump();
    EXPECT_LE(row["worst"].get<double>(), row["bound"].get<double>()) << row.dump();
  }
}

TEST(StressCommand, TheTableSaysHowManyHeld) {
  const ProgramResult result = run_program({"stress"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, testing::ContainsRegex("\n([0-9]+) of [0-9]+ cases within their bounds\n$"));
  EXPECT_THAT(result.out, testing::Not(HasSubstr("BEYOND")));
}

class AccuracyCommandLine : public testing::Test {
 protected:
  ProgramResult run(std::vector<std::string> arguments) {
    ProgramOptions options;
    options.folder = folder_.path();
    options.deadline = std::chrono::seconds(120);
    arguments.insert(arguments.begin(), {"bench", "accuracy", "--effort", "0.02", "--repeat", "1"});
    return run_program(arguments, std::move(options));
  }
  test::ScratchFolder folder_;
};

TEST_F(AccuracyCommandLine, RowsCompareEveryWayWithTheTruth) {
  const ProgramResult result = run({"--json", "--csv", "rows.csv", "--html", "page.html"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto rows = rows_of(result.out);
  std::set<std::string> seen;
  std::size_t fronts = 0;
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    const std::string name = row["name"];
    const std::string variant = row["variant"];
    EXPECT_TRUE(seen.insert(name + '|' + variant).second) << "two rows of one name and variant";
    EXPECT_GT(row["time_ns"].get<double>(), 0.0);
    EXPECT_TRUE(std::isfinite(row["max_abs_error"].get<double>()) && row["max_abs_error"] >= 0.0);
    EXPECT_NE(row["reference"], "");
    if (row["pareto"].get<bool>()) ++fronts;
  }
  for (const char* way : {"f32, cut 1e-06, grid", "compensated, cut 0, none"})
    EXPECT_TRUE(seen.contains("tags a sweep finds, expected, of 100|" + std::string(way))) << way;
  EXPECT_GT(fronts, 5U);
  EXPECT_LT(fronts, rows.size());
  EXPECT_THAT(folder_.read("rows.csv"), testing::StartsWith("name,variant,time_ns,"));
  EXPECT_THAT(folder_.read("page.html"), HasSubstr("</html>"));
}

TEST_F(AccuracyCommandLine, OneThingAtATimeOnStdout) {
  const ProgramResult result = run({"--json", "--csv", "-"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("--json"));
}

TEST_F(AccuracyCommandLine, AnEffortOfNothingIsRefused) {
  const ProgramResult result = run_program({"bench", "accuracy", "--effort", "0"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--effort"));
}

}  // namespace
}  // namespace forager::tools
