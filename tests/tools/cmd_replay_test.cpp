// `forager run --record` and `forager replay` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/places.hpp"
#include "tests/scratch_folder.hpp"
#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(CmdReplay, ARecordedMissionIsFlownAgainTheSame) {
  const test::ScratchFolder folder;
  const std::string file = folder.file("flight.recording");
  const std::string scene = test::source_path("scenes/3A.toml");
  const auto flown = run_program({"run", scene, "--seed", "5", "--no-files", "--quiet", "--record", file});
  ASSERT_EQ(flown.exit_code, 0) << flown.err;
  const auto replayed = run_program({"replay", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_THAT(replayed.out, AllOf(HasSubstr("scenes/3A.toml, seed 5, board sim\n"),
                                  HasSubstr(" calls the same, byte for byte; ")));
  const auto lines = lines_of(run_program({"replay", file, "--json"}).out);
  ASSERT_GT(lines.size(), 5U);
  EXPECT_EQ(lines.front()["event"], "recording");
  EXPECT_EQ(lines.back()["identical"], true);
}

TEST(CmdReplay, ABenchIsShownAndNotRun) {
  const test::ScratchFolder folder;
  const std::string file = folder.write("bench.recording",
                                        "forager recording 1\n"
                                        "1.000000000 recorder start = ok\n"
                                        "1.500000000 gpio%20chip/LAMP set 1 = ok\n"
                                        "2.000000000 gpio%20chip/LAMP set 0 = error io a b c - 5\n"
                                        "2.250000000 gpio%20chip/STOP <level = ok 1\n");
  const auto shown = run_program({"replay", file});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_EQ(shown.out,
            "recording   of a bench\n"
            "length      1.250 s, 4 records\n"
            "device      gpio chip/LAMP: 2 calls, 0 arrivals, 1 errors\n"
            "device      gpio chip/STOP: 0 calls, 1 arrivals, 0 errors\n");
}

TEST(CmdReplay, WhatIsNoRecordingIsSaid) {
  const test::ScratchFolder folder;
  const auto missing = run_program({"replay", folder.file("none")});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("forager run SCENE --record FILE"));
  const auto wrong = run_program({"replay", folder.write("x", "forager recording 1\n1.0 a\nb\n")});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("line 2: "));
}

}  // namespace
}  // namespace forager::tools
