// What `forager bench speed` prints. How fast it is depends on the machine and is no business of a test.
#include "tools/cmd_bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/places.hpp"
#include "tools/bench_duel.hpp"
#include "tools/bench_row.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

const std::string kSmall = test::data_path("mission/small.toml");

class BenchCommandLine : public testing::Test {
 protected:
  int run(std::vector<std::string> arguments) {
    CLI::App app("forager");
    int exit_code = -1;
    add_bench_command(app, exit_code);
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them last first
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    app.parse(arguments);
    out_ = testing::internal::GetCapturedStdout();
    err_ = testing::internal::GetCapturedStderr();
    return exit_code;
  }
  std::string out_;
  std::string err_;
};

TEST_F(BenchCommandLine, JsonRowsAreWholeAndTheirFiguresFiniteAndPositive) {
  ASSERT_EQ(run({"bench", "speed", "--json", "--repeat", "1", "--scene", kSmall}), kExitDone) << err_;
  const std::set<std::string> expected{"name", "ours", "unit", "peer", "peer_value", "ratio"};
  std::istringstream lines(out_);
  std::set<std::string> names;
  double parts = 0.0;
  for (std::string line; std::getline(lines, line);) {
    SCOPED_TRACE(line);
    const auto row = nlohmann::json::parse(line);
    std::set<std::string> keys;
    for (const auto& [key, value] : row.items()) keys.insert(key);
    EXPECT_EQ(keys, expected);
    const double ours = row["ours"];
    const double peer = row["peer_value"];
    const double ratio = row["ratio"];
    EXPECT_TRUE(std::isfinite(ours) && ours > 0.0);
    EXPECT_TRUE(std::isfinite(peer) && peer > 0.0);
    EXPECT_NEAR(ratio, ours / peer, 1e-9 * ratio);
    EXPECT_TRUE(names.insert(row["name"]).second) << "two rows of one name";
    if (row["peer"] == "whole run") parts += ratio;
  }
  EXPECT_TRUE(names.contains("mission small"));
  EXPECT_TRUE(names.contains("AdvanNet event decode"));
  EXPECT_GE(names.size(), 10U);
  EXPECT_NEAR(parts, 1.0, 1e-6);  // the parts of a mission make the whole of it
}

TEST_F(BenchCommandLine, AMissingSceneIsAnErrorNotARow) {
  EXPECT_EQ(run({"bench", "speed", "--scene", "no/such.toml"}), kExitUnavailable);
  EXPECT_EQ(out_, "");
  EXPECT_THAT(err_, HasSubstr("no/such.toml"));
}

TEST_F(BenchCommandLine, NoMeasurementAtAllIsRefused) {
  for (const char* count : {"0", "-1", "1001", "3x", ""}) {
    CLI::App app("forager");
    int exit_code = -1;
    add_bench_command(app, exit_code);
    std::vector<std::string> arguments{"--repeat=" + std::string(count), "speed", "bench"};
    EXPECT_THROW(app.parse(arguments), CLI::ParseError) << count;
    EXPECT_EQ(exit_code, -1);
  }
}

TEST(BenchTable, ScalesUnitsAndSaysHowLongOneTakes) {
  const std::vector<BenchRow> rows{{"decode", 12.5e6, "events/s", "other", 2.5e6},
                                   {"part", 0.02, "s", "whole run", 0.08},
                                   {"alone", 3.0, "m", "", std::nullopt}};
  const std::string table = bench_table(rows);
  EXPECT_THAT(table, HasSubstr("12.5 Mevents/s (80.0 ns)"));
  EXPECT_THAT(table, HasSubstr("5 x  other: 2.50 Mevents/s (400 ns)"));
  EXPECT_THAT(table, HasSubstr("20.0 ms"));
  EXPECT_THAT(table, HasSubstr("25.0 %  whole run: 80.0 ms"));
  const auto alone = nlohmann::json::parse(bench_json(rows[2]));
  EXPECT_TRUE(alone["peer"].is_null() && alone["peer_value"].is_null() && alone["ratio"].is_null());
}

TEST(BenchDuel, WaysThatDisagreeAreNotMeasured) {
  int calls = 0;
  const auto count = [&calls] { ++calls; };
  const Duel wrong{"sum", "sums/s", "other", 1.0, count, count, [] { return false; }};
  const auto row = measure(wrong, {});
  ASSERT_FALSE(row);
  EXPECT_THAT(describe(row.error()), HasSubstr("do not come to the same result"));
  EXPECT_EQ(calls, 0);
}

TEST(BenchDuel, TheMedianIgnoresOneBadMeasurement) {
  EXPECT_DOUBLE_EQ(median_of({3.0, 1.0, 1000.0}), 3.0);
  EXPECT_DOUBLE_EQ(median_of({4.0, 1.0, 3.0, 1000.0}), 3.5);
  EXPECT_DOUBLE_EQ(median_of({5.0}), 5.0);
}

}  // namespace
}  // namespace forager::tools
