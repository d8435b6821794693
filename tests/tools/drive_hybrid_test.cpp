// `forager drive` of a scene whose vehicle may also fly, from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kHop = test::source_path("scenes/hop.toml");

TEST(DriveHybrid, HopsAndPrintsItsAssumptions) {
  const ProgramResult result = run_program({"drive", kHop, "--seed", "4", "--runs", "2"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("2 of 2 runs"), HasSubstr("no way round on the ground"),
                                HasSubstr("assumed: mass 3.50 kg"), HasSubstr("nothing of it was measured")));
}

TEST(DriveHybrid, JsonIsOneLine) {
  const ProgramResult result = run_program({"drive", kHop, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  const auto line = nlohmann::json::parse(result.out);
  EXPECT_EQ(line["hops"], 1);
  EXPECT_EQ(line["arrived"], 1);
  EXPECT_GT(line["least_over_m"], 0.2);
}

TEST(DriveHybrid, WritesAJournalOfTheFirstRun) {
  test::ScratchFolder folder;
  const std::string path = folder.file("journal.txt");
  ASSERT_EQ(run_program({"drive", kHop, "--journal", path}).exit_code, 0);
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  for (const char* part :
       {"hybrid leg 1 rolling", "hybrid leg 2 climbing", "hybrid leg 2 landing", "hybrid end arrived"})
    EXPECT_THAT(text.str(), HasSubstr(part));
}

TEST(DriveHybrid, RefusesWhatOnlyRollingScenesHave) {
  const ProgramResult result = run_program({"drive", kHop, "--faults"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--faults"));
}

TEST(DriveHybrid, SaysWhyThereIsNoRoute) {
  test::ScratchFolder folder;
  const std::string scene = folder.write("wall.toml", "base = \"" + kHop + R"("
[[obstacles]]
min = [3.0, -2.5]
max = [3.2, 2.5]
height_m = 3.0
)");
  const ProgramResult result = run_program({"drive", scene});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("too_high"), HasSubstr("no way on the ground")));
}

}  // namespace
}  // namespace forager::tools
