#include "hal/linux/steady_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace forager::hal {
namespace {

TEST(SteadyClock, SleepsUntilTheInstantAndNotLess) {
  auto clock = make_steady_clock();
  const Instant start = clock->now();
  clock->sleep_until(start + 20ms);
  EXPECT_GE(clock->now() - start, 20ms);
  EXPECT_LT(clock->now() - start, 2s);
}

TEST(SteadyClock, ReturnsAtOnceFromThePast) {
  auto clock = make_steady_clock();
  const Instant start = clock->now();
  clock->sleep_until(start - 1h);
  clock->sleep_until(Instant(-1s));
  EXPECT_LT(clock->now() - start, 1s);
}

TEST(SteadyClock, RunsFasterByItsFactor) {
  auto real = make_steady_clock();
  auto fast = make_steady_clock(100.0);
  const Instant real_start = real->now();
  const Instant fast_start = fast->now();
  fast->sleep_until(fast_start + 2s);
  const double real_s = to_seconds(real->now() - real_start);
  EXPECT_GE(fast->now() - fast_start, 2s);
  EXPECT_GE(real_s, 0.0199);
  EXPECT_LT(real_s, 1.0);
}

TEST(SteadyClock, TakesANonsenseFactorAsRealTime) {
  for (const double speed : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    auto real = make_steady_clock();
    auto odd = make_steady_clock(speed);
    EXPECT_LT(std::chrono::abs(odd->now() - real->now()), 1s) << speed;
  }
}

}  // namespace
}  // namespace forager::hal
