// `forager drive` of a scene that only rolls, from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kCourse = test::source_path("scenes/course.toml");

TEST(DriveCommandLine, TakesAWholeNumberOfRuns) {
  for (const char* runs : {"0", "10000001", "-1", "1.5"}) {
    const ProgramResult result = run_program({"drive", kCourse, "--runs", runs});
    EXPECT_EQ(result.exit_code, 2) << runs;
    EXPECT_THAT(result.err, AllOf(HasSubstr("--runs"), HasSubstr("from 1 to 10000000"))) << runs;
  }
}

// Faults strike after some seconds of moving: nobody stands long enough on the goal for that.
TEST(DriveCommandLine, ACampaignThatStruckNothingIsNoPass) {
  test::ScratchFolder folder;
  const std::string scene =
      folder.write("short.toml", "base = \"" + kCourse + "\"\n[drive]\ntime_limit_s = 1\n");
  const ProgramResult result = run_program({"drive", scene, "--faults", "--runs", "1"});
  EXPECT_EQ(result.exit_code, 4) << result.out;
  EXPECT_THAT(result.err, HasSubstr("no run was struck by"));
}

}  // namespace
}  // namespace forager::tools
