#include "boards/running_moments.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace forager::boards {
namespace {

TEST(RunningMoments, OfFewNumbers) {
  RunningMoments m;
  EXPECT_EQ(m.mean(), 0.0);
  EXPECT_EQ(m.variance(), 0.0);
  m.add(4.0);
  EXPECT_EQ(m.mean(), 4.0);
  EXPECT_EQ(m.standard_error(), 0.0);
  m.add(8.0);
  EXPECT_EQ(m.mean(), 6.0);
  EXPECT_EQ(m.variance(), 8.0);
  EXPECT_EQ(m.standard_error(), 2.0);
}

RC_GTEST_PROP(RunningMoments, MergingIsSeeingAll,
              (std::vector<std::int32_t> first, std::vector<std::int32_t> more)) {
  RunningMoments all, left, right;
  for (const auto value : first) {
    all.add(value);
    left.add(value);
  }
  for (const auto value : more) {
    all.add(value);
    right.add(value);
  }
  left.merge(right);
  RC_ASSERT(left.count() == all.count());
  RC_ASSERT(std::abs(left.mean() - all.mean()) <= 1e-15 * 0x1p32);
  RC_ASSERT(std::abs(left.variance() - all.variance()) <= 1e-12 * (1.0 + all.variance()));
}

}  // namespace
}  // namespace forager::boards
