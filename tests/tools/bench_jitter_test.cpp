#include <gtest/gtest.h>

#include <string>

#include "tests/tools/bench_command.hpp"
#include "tests/tools/program.hpp"

namespace forager::tools {
namespace {

TEST(BenchJitter, MeasuresBothRatesIdleAndUnderLoad) {
  const ProgramResult result = run_program({"bench", "jitter", "--seconds", "0.1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto rows = lines_of(result.out);
  ASSERT_EQ(rows.size(), 28U);
  for (std::size_t i = 0; i < rows.size(); i += 7)
    for (const std::size_t first : {i, i + 3}) {  // median, 99 %, worst of pulse and period
      EXPECT_GE(rows[first]["ours"], 0.0);
      EXPECT_LE(rows[first]["ours"], rows[first + 1]["ours"]);
      EXPECT_LE(rows[first + 1]["ours"], rows[first + 2]["ours"]);
    }
  EXPECT_EQ(rows[0]["name"], "software PWM 50 Hz idle: pulse off by, median");
  EXPECT_EQ(rows[21]["name"], "software PWM 333 Hz under load: pulse off by, median");
}

TEST(BenchJitter, RefusesTimesThatAreNone) {
  expect_refusal({"bench", "jitter", "--seconds", "0"}, 2, testing::HasSubstr("--seconds"));
}

}  // namespace
}  // namespace forager::tools
