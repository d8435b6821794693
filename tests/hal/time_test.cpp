#include "hal/time.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "mocks/virtual_clock.hpp"

namespace forager::hal {
namespace {

TEST(FromSeconds, RoundsToTheNearestNanosecond) {
  EXPECT_EQ(Duration(1'500'000'000), from_seconds(1.5));
  EXPECT_EQ(Duration(1), from_seconds(0.6e-9));
  EXPECT_EQ(Duration(0), from_seconds(0.4e-9));
  EXPECT_EQ(Duration(-1), from_seconds(-0.6e-9));
  EXPECT_EQ(Duration(100'000'000), from_seconds(0.1));
}

TEST(FromSeconds, SaturatesInsteadOfOverflowing) {
  EXPECT_EQ(Duration::max(), from_seconds(1e300));
  EXPECT_EQ(Duration::max(), from_seconds(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(Duration::min(), from_seconds(-1e300));
  EXPECT_EQ(Duration::zero(), from_seconds(std::numeric_limits<double>::quiet_NaN()));
}

TEST(ToMilliseconds, FloorsOnBothSidesOfZero) {
  EXPECT_EQ(1, to_milliseconds(Instant(1'999'999ns)));
  EXPECT_EQ(-1, to_milliseconds(Instant(-1ns)));
}

TEST(Deadline, ExpiresAtItsInstantAndNotBefore) {
  const Instant start(5s);
  Deadline deadline(start, 2s);
  EXPECT_TRUE(deadline.armed());
  EXPECT_FALSE(deadline.expired(start + 2s - 1ns));
  EXPECT_TRUE(deadline.expired(start + 2s));
  deadline.disarm();
  EXPECT_FALSE(deadline.expired(start + 1000s));
}

TEST(Deadline, IsDisarmedByDefault) {
  EXPECT_FALSE(Deadline().armed());
  EXPECT_FALSE(Deadline().expired(Instant::max()));
}

TEST(VirtualClock, JumpsForwardAndNeverBack) {
  mocks::VirtualClock clock(Instant(10s));
  clock.sleep_until(Instant(12s));
  EXPECT_EQ(Instant(12s), clock.now());
  clock.sleep_until(Instant(1s));
  EXPECT_EQ(Instant(12s), clock.now());
  clock.advance(500ms);
  clock.advance(-3s);
  EXPECT_EQ(Instant(12500ms), clock.now());
}

}  // namespace
}  // namespace forager::hal
