// `forager reproduce` and `forager calibrate` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"
#include "tools/cli_style.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

const std::string kScenes = test::source_path("scenes");
const std::string kShelf = test::data_path("mission/calibration.toml");

ProgramResult forager(const std::vector<std::string>& arguments) {
  ProgramOptions options;
  options.deadline = std::chrono::minutes(4);
  return Program(arguments, options).finish();
}

std::vector<nlohmann::json> rows_of(const std::string& text) {
  std::vector<nlohmann::json> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) rows.push_back(nlohmann::json::parse(line));
  return rows;
}

// A page that opens everywhere: well-formed, nothing loaded, no script.
void expect_self_contained(const std::string& page) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(page.c_str(), pugi::parse_full)) << page.substr(0, 200);
  for (const char* loaded : {"<script", "src=", "href=", "url(", "@import"})
    EXPECT_EQ(page.find(loaded), std::string::npos) << loaded;
  EXPECT_THAT(page, HasSubstr("<svg"));
}

TEST(ReproduceCommand, JsonRowsEndInTheRootMeanSquare) {
  const auto result =
      forager({"reproduce", "--scenes", kScenes, "--seeds", "2", "--runs", "1A,2B,ch4-1", "--json"});
  ASSERT_EQ(result.exit_code, kExitDone) << result.err;
  const auto rows = rows_of(result.out);
  ASSERT_EQ(rows.size(), 4U);
  double squares = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    SCOPED_TRACE(rows[i].dump());
    for (const char* key : {"run", "published", "median", "p5", "p95", "difference", "duration_s"})
      EXPECT_TRUE(rows[i].contains(key)) << key;
    EXPECT_LE(rows[i]["p5"], rows[i]["median"]);
    EXPECT_GE(rows[i]["p95"], rows[i]["median"]);
    EXPECT_GT(rows[i]["duration_s"], 10.0);
    if (rows[i]["published"].is_null()) continue;
    const double difference = rows[i]["difference"];
    EXPECT_NEAR(difference, rows[i]["median"].get<double>() - rows[i]["published"].get<double>(), 1e-9);
    squares += difference * difference;
  }
  EXPECT_EQ(rows[0]["run"], "1A");
  EXPECT_TRUE(rows[2]["published"].is_null());
  EXPECT_GT(rows[2]["tags_against_time"].size(), 10U);
  EXPECT_NEAR(rows[3]["rms_points"], std::sqrt(squares / 2.0), 1e-9);
}

TEST(ReproduceCommand, WritesATableAndAPage) {
  const test::ScratchFolder folder;
  const auto result = forager({"reproduce", "--scenes", kScenes, "--seeds", "1", "--runs", "1B,ch4-2",
                               "--html", folder.file("page.html")});
  ASSERT_EQ(result.exit_code, kExitDone) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1B"));
  EXPECT_THAT(result.out, HasSubstr("50.9"));
  EXPECT_THAT(result.out, HasSubstr("Root mean square difference"));
  EXPECT_THAT(result.out, HasSubstr("Tags against time, ch4-2"));
  expect_self_contained(folder.read("page.html"));
}

TEST(ReproduceCommand, RefusesWhatItDoesNotKnow) {
  const auto unknown = forager({"reproduce", "--scenes", kScenes, "--runs", "1A,1Z"});
  EXPECT_EQ(unknown.exit_code, kExitUsage);
  EXPECT_THAT(unknown.err, HasSubstr("1Z"));
  EXPECT_EQ(forager({"reproduce", "--seeds", "0"}).exit_code, kExitUsage);
  EXPECT_EQ(forager({"reproduce", "--scenes", "/no/such", "--runs", "1A"}).exit_code, kExitUnavailable);
}

class CalibrateCommandLine : public testing::Test {
 protected:
  // Files of a simulated recording.
  void record(const std::string& seconds) {
    const auto result = forager(
        {"calibrate", "--simulate", folder_.path(), "--scene", kShelf, "--seconds", seconds, "--seed", "3"});
    ASSERT_EQ(result.exit_code, kExitDone) << result.err;
  }
  ProgramResult fit(std::vector<std::string> more) {
    std::vector<std::string> arguments{"calibrate",
                                       "--reads",
                                       folder_.file("reads.csv"),
                                       "--poses",
                                       folder_.file("poses.csv"),
                                       "--tags",
                                       folder_.file("tags.csv"),
                                       "--scene",
                                       kShelf};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return forager(arguments);
  }
  test::ScratchFolder folder_;
};

TEST_F(CalibrateCommandLine, FitsARecordingAndShowsResiduals) {
  record("48");
  const auto result = fit({"--json", "--html", folder_.file("page.html")});
  ASSERT_EQ(result.exit_code, kExitDone) << result.err;
  const auto rows = rows_of(result.out);
  ASSERT_GE(rows.size(), 5U);
  EXPECT_EQ(rows[0]["parameter"], "r0_m");
  EXPECT_LT(rows[0]["low"], rows[0]["value"]);
  EXPECT_GT(rows[0]["high"], rows[0]["value"]);
  EXPECT_EQ(rows[1]["parameter"], "spread_db");
  EXPECT_EQ(rows[2]["parameter"], "rician_k_db");
  EXPECT_TRUE(rows[3].contains("residual"));
  EXPECT_TRUE(rows.back().contains("log_likelihood"));
  expect_self_contained(folder_.read("page.html"));
}

TEST_F(CalibrateCommandLine, DataThatCannotTellIsRefusedByNameAndReason) {
  record("3");
  const auto result = fit({});
  EXPECT_EQ(result.exit_code, kExitCheckFailed);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("r0_m"));
  EXPECT_THAT(result.err, HasSubstr("reads of known tags"));
}

TEST_F(CalibrateCommandLine, ABrokenFileIsNamedWithLineAndColumn) {
  record("3");
  folder_.write("poses.csv", "time_s,x,y,z,yaw\n0,0,0,1.8,0\n1,0,zero,1.8,0\n");
  const auto result = fit({});
  EXPECT_EQ(result.exit_code, kExitUsage);
  EXPECT_THAT(result.err, HasSubstr("poses.csv"));
  EXPECT_THAT(result.err, HasSubstr("line 3, column y"));
}

TEST(CalibrateCommand, AsksForWhatIsMissing) {
  EXPECT_EQ(forager({"calibrate"}).exit_code, kExitUsage);
  EXPECT_EQ(forager({"calibrate", "--reads", "a.csv"}).exit_code, kExitUsage);
  EXPECT_EQ(forager({"calibrate", "--published", "--simulate", "x"}).exit_code, kExitUsage);
  EXPECT_EQ(
      forager({"calibrate", "--reads", "/no/a", "--poses", "/no/b", "--tags", "/no/c", "--scene", kShelf})
          .exit_code,
      kExitUnavailable);
}

}  // namespace
}  // namespace forager::tools
