// `forager depth` from outside, through an emulated camera.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/places.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/socket_rig.hpp"

namespace forager::tools {
namespace {

using testing::HasSubstr;

// The bench's own shelf stands 2 m ahead, from 1 m left to 1 m right of the camera.
TEST(CmdDepth, OneFrameShowsTheShelfAheadAndTheVerdict) {
  const ProgramResult result = run_program({"depth", "frame", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json frame = last_event(result.out, "frame");
  EXPECT_EQ(frame["sectors"].size(), 9U);
  EXPECT_NEAR(frame["sectors"][4]["nearest_m"].get<double>(), 2.0, 0.01);
  EXPECT_TRUE(frame["sectors"][0]["nearest_m"].is_null());
  EXPECT_TRUE(frame["sectors"][8]["nearest_m"].is_null());
  EXPECT_NEAR(frame["guard"]["range_m"].get<double>(), 2.0, 0.01);
  const ProgramResult text = run_program({"depth", "frame"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("80 x 60 pixels"));
  EXPECT_THAT(text.out, HasSubstr("nearest at the body's height: 2.00 m"));
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), 3 + 9) << text.out;
}

TEST(CmdDepth, FasterMeansMoreRoomIsWanted) {
  const auto guard = [](const char* speed) {
    return last_event(run_program({"depth", "frame", "--speed", speed, "--json"}).out, "frame")["guard"];
  };
  const Json slow = guard("0");
  const Json fast = guard("3");
  EXPECT_EQ(slow["way"], "clear");
  EXPECT_EQ(fast["way"], "blocked");
  EXPECT_EQ(fast["reason"], "obstacle");
  EXPECT_GT(fast["required_m"], slow["required_m"]);
}

TEST(CmdDepth, WatchRepeatsItAndEqualSeedsPrintEqualBytes) {
  const std::vector<std::string> watch{"depth", "watch", "--for", "2s", "--every", "500ms"};
  const ProgramResult result = run_program(watch);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 5) << result.out;
  EXPECT_EQ(run_program(watch).out, result.out);
}

TEST(CmdDepth, ASceneBringsItsOwnShelves) {
  const std::string scene = test::source_path("scenes/4A.toml");
  const Json frame = last_event(run_program({"depth", "frame", "--scene", scene, "--json"}).out, "frame");
  // 4A's aisle is 3.5 m wide: shelves at both sides, the way ahead free.
  EXPECT_TRUE(frame["sectors"][0]["nearest_m"].is_number());
  EXPECT_TRUE(frame["sectors"][8]["nearest_m"].is_number());
  EXPECT_EQ(frame["guard"]["way"], "clear");
}

TEST(CmdDepth, RefusesWhatCannotWork) {
  expect_refusals({
      {{"depth"}, 2, "frame, watch"},
      {{"depth", "watch"}, 2, "--for"},
      {{"depth", "frame", "--scene", "no/such.toml"}, 3, "no/such.toml"},
  });
}

}  // namespace
}  // namespace forager::tools
