#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tools/program.hpp"
#include "tests/tools/socket_rig.hpp"  // lines_of()

// What tests of the bench commands share.
namespace forager::tools {

// Nothing is done, nothing is printed, and one line on stderr says why.
inline void expect_refusal(const std::vector<std::string>& arguments, int exit_code,
                           const testing::Matcher<const std::string&>& says) {
  const ProgramResult result = run_program(arguments);
  SCOPED_TRACE(testing::PrintToString(arguments));
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, testing::AllOf(testing::StartsWith("forager: "), says));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

struct Refusal {
  std::vector<std::string> arguments;
  int exit_code;
  const char* says;
};

inline void expect_refusals(const std::vector<Refusal>& refusals) {
  for (const Refusal& refusal : refusals)
    expect_refusal(refusal.arguments, refusal.exit_code, testing::HasSubstr(refusal.says));
}

}  // namespace forager::tools
