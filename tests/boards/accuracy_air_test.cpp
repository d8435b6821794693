#include <gtest/gtest.h>

#include "boards/accuracy_row.hpp"

namespace forager::boards {
namespace {

TEST(AccuracyAir, BothModelsFindWhatTheSumOfProbabilitiesPromises) {
  const auto rows = accuracy_air({.seed = 2, .effort = 0.1});
  ASSERT_EQ(rows.size(), 18U);
  for (const AccuracyRow& row : rows) {
    SCOPED_TRACE(row.name + ": " + row.variant);
    // Four runs of some 125 tags, half of them certain: four deviations are 12 %. Frames are far closer.
    EXPECT_LT(row.max_rel_error, 0.12);
    EXPECT_GT(row.max_rel_error, 0.0);
    EXPECT_TRUE(row.work != nullptr);
    row.work();
  }
}

}  // namespace
}  // namespace forager::boards
