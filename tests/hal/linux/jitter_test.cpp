#include "hal/linux/jitter.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace forager::hal {
namespace {

using namespace std::chrono_literals;

TEST(Jitter, NothingCameNothingWasLate) {
  const Jitter jitter;
  EXPECT_EQ(jitter.count(), 0U);
  EXPECT_EQ(jitter.quantile(0.5), 0ns);
  EXPECT_EQ(jitter.max(), 0ns);
}

TEST(Jitter, WhatComesTooEarlyIsNotLate) {
  Jitter jitter;
  jitter.add(-5us);
  EXPECT_EQ(jitter.count(), 1U);
  EXPECT_EQ(jitter.max(), 0ns);
}

RC_GTEST_PROP(Jitter, QuantilesAreThoseOfTheSortedValuesToSixPercent, ()) {
  const auto values = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::int64_t>>(rc::gen::inRange<std::int64_t>(0, 5'000'000'000)));
  Jitter jitter;
  for (const std::int64_t ns : values) jitter.add(Duration(ns));
  auto sorted = values;
  std::sort(sorted.begin(), sorted.end());
  for (const double share : {0.0, 0.5, 0.9, 0.99, 1.0}) {
    const double rank = std::ceil(share * static_cast<double>(sorted.size()));
    const std::int64_t exact = sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
    const std::int64_t got = jitter.quantile(share).count();
    RC_ASSERT(got >= exact);
    RC_ASSERT(static_cast<double>(got) <= static_cast<double>(exact) * 1.0626 + 1.0);
  }
  RC_ASSERT(jitter.max().count() == sorted.back());
  RC_ASSERT(jitter.count() == values.size());
}

}  // namespace
}  // namespace forager::hal
