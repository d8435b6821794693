#include "hal/error.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <set>

namespace forager::hal {
namespace {

TEST(Describe, SaysWhereWhatWhyAndHowToMendIt) {
  const Error error{ErrorCode::refused,         "AdvanReader at 192.168.1.50:3161", "PUT antennas",
                    "answered PARAMETER_ERROR", "Correct [reader] ports",           0};
  EXPECT_EQ(
      "AdvanReader at 192.168.1.50:3161: PUT antennas: answered PARAMETER_ERROR. Correct [reader] ports",
      describe(error));
}

TEST(Describe, AddsTheTextOfErrno) {
  const Error error{ErrorCode::permission, "tcp listen 0.0.0.0:80", "bind", "forbidden", "", EACCES};
  EXPECT_EQ("tcp listen 0.0.0.0:80: bind: forbidden [Permission denied]", describe(error));
}

TEST(Describe, FallsBackToTheCodeWhenThereIsNoDetail) {
  EXPECT_EQ("timed out", describe(Error{ErrorCode::timeout, "", "", "", "", 0}));
}

TEST(ErrorCodes, HaveDistinctTexts) {
  std::set<std::string_view> texts;
  constexpr int kLast = static_cast<int>(ErrorCode::unsupported);
  for (int code = 0; code <= kLast; ++code) texts.insert(to_string(static_cast<ErrorCode>(code)));
  EXPECT_EQ(static_cast<std::size_t>(kLast) + 1, texts.size());
  EXPECT_FALSE(texts.contains("unknown error"));
}

Result<> inner(bool good) {
  if (good) return {};
  return fail(ErrorCode::no_ack, "servo", "write", "no answer");
}

Result<int> outer(bool good) {
  FORAGER_TRY(inner(good));
  return 7;
}

TEST(ForagerTry, LeavesWithTheErrorOrGoesOn) {
  EXPECT_EQ(7, outer(true).value());
  EXPECT_EQ(ErrorCode::no_ack, outer(false).error().code);
  EXPECT_EQ("servo", outer(false).error().device);
}

}  // namespace
}  // namespace forager::hal
