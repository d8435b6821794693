#include "boards/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace forager::boards {
namespace {

using Way = SweepByKernel::Way;

class OnASweep : public testing::Test {
 protected:
  const Sweep sweep_{3, 200};
  const double exact_ = sweep_.expected_tags(sweep_.exact_exposure);
};

TEST_F(OnASweep, FindsSomeTagsAndNeverThoseBehind) {
  EXPECT_GT(exact_, 10.0);
  EXPECT_LT(exact_, 100.0);
  for (std::size_t i = 0; i < sweep_.world.tags.size(); ++i)
    if (sweep_.world.tags.position(i).y <= 0.0) {
      EXPECT_EQ(sweep_.exact_exposure[i], 0.0);
    }
  EXPECT_LT(sweep_.expected_tags(sweep_.exact_exposure, 0.5), exact_);
}

TEST_F(OnASweep, EveryWayComesAsNearAsItsArithmeticAndItsCut) {
  const auto off = [&](Way way, double cut, bool grid) {
    return std::abs(sweep_.expected_tags(SweepByKernel(sweep_, way, cut, grid).exposure()) - exact_);
  };
  for (const bool grid : {true, false}) {
    EXPECT_LE(off(Way::compensated, 0.0, grid), 1e-11);
    EXPECT_LE(off(Way::f64, 0.0, grid), 1e-11);
    EXPECT_LE(off(Way::f32, 0.0, grid), 1e-3);
    // 200 tags, each below the cut all the time.
    EXPECT_LE(off(Way::f64, 1e-6, grid), 200 * 1e-6);
    EXPECT_GT(off(Way::f64, 1e-6, grid), 1e-9);
  }
}

TEST_F(OnASweep, TheGridLeavesOutOnlyWhatTheCutLeavesOut) {
  for (const double cut : {1e-9, 1e-6})
    EXPECT_EQ(SweepByKernel(sweep_, Way::f64, cut, true).exposure(),
              SweepByKernel(sweep_, Way::f64, cut, false).exposure());
}

}  // namespace
}  // namespace forager::boards
