#include "reader/clock_offset.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "hal/random.hpp"

namespace forager::reader {
namespace {

using namespace std::chrono_literals;
using Outcome = ClockOffset::Outcome;

constexpr std::int64_t kFebruary2016 = 1'455'148'800'000;
constexpr std::int64_t kMay2026 = 1'779'868'340'000;

hal::Instant at(hal::Duration since) { return hal::Instant(since); }

TEST(ClockOffset, KnowsNothingBeforeTheFirstStamp) {
  const ClockOffset clock;
  EXPECT_FALSE(clock.known());
  EXPECT_EQ(clock.to_instant(kMay2026, at(7s)), at(7s));
}

TEST(ClockOffset, ReaderTenYearsBehindGivesTheSameInstants) {
  for (const std::int64_t epoch : {kFebruary2016, kMay2026}) {
    ClockOffset clock;
    EXPECT_EQ(clock.add(at(100s), at(100s + 20ms), epoch), Outcome::first);
    EXPECT_EQ(clock.to_instant(epoch + 500, {}), at(100s + 510ms));
    EXPECT_EQ(clock.to_reader_ms(at(100s + 510ms)), epoch + 500);
    EXPECT_EQ(clock.uncertainty(at(100s + 10ms)), hal::Duration(11ms));
  }
}

TEST(ClockOffset, PrefersTheQuickReply) {
  ClockOffset clock;
  clock.add(at(0s), at(2s), kMay2026 + 1900);  // the stamp came late in a slow exchange
  EXPECT_EQ(clock.add(at(5s), at(5s + 10ms), kMay2026 + 5005), Outcome::better);
  EXPECT_EQ(clock.to_instant(kMay2026 + 6000, {}), at(6s));
  EXPECT_EQ(clock.add(at(7s), at(9s), kMay2026 + 8000), Outcome::kept);
  EXPECT_EQ(clock.to_instant(kMay2026 + 6000, {}), at(6s));
  EXPECT_EQ(clock.steps(), 0U);
}

TEST(ClockOffset, ClockSetByTenYearsIsAStep) {
  ClockOffset clock;
  clock.add(at(0s), at(10ms), kFebruary2016);
  EXPECT_EQ(clock.add(at(60s), at(60s + 10ms), kMay2026 + 60'000), Outcome::stepped);
  EXPECT_NEAR(static_cast<double>(clock.last_step_ms()), static_cast<double>(kMay2026 - kFebruary2016), 20.0);
  EXPECT_EQ(clock.to_instant(kMay2026 + 61'000, {}), at(61s + 5ms));
}

TEST(ClockOffset, SmallStepBeyondBothBoundsIsSeen) {
  ClockOffset clock;
  clock.add(at(0s), at(10ms), kMay2026);
  EXPECT_EQ(clock.add(at(1s), at(1s + 10ms), kMay2026 + 1000 - 40), Outcome::stepped);
  EXPECT_NEAR(static_cast<double>(clock.last_step_ms()), -40.0, 1.0);
}

TEST(ClockOffset, FarAwayTimesFallBackInsteadOfOverflowing) {
  ClockOffset clock;
  clock.add(at(0s), at(0s), kMay2026);
  EXPECT_EQ(clock.to_instant(1, at(3s)), at(3s));
  EXPECT_EQ(clock.to_instant(100'000'000'000'000, at(3s)), at(3s));
}

// Whatever the network does, the true time lies within the bound the estimate claims.
TEST(ClockOffset, BoundHoldsUnderJitterAndDrift) {
  hal::Random random(11);
  for (const double drift : {-150e-6, 0.0, 150e-6}) {
    ClockOffset clock;
    hal::Duration now = 5s;
    for (int i = 0; i < 2000; ++i) {
      const hal::Duration to = hal::from_seconds(0.001 + 0.05 * random.exponential());
      const hal::Duration back = hal::from_seconds(0.001 + 0.05 * random.exponential());
      const auto reader_clock = [drift](hal::Duration when) {
        return kMay2026 + static_cast<std::int64_t>(hal::to_seconds(when) * (1.0 + drift) * 1e3);
      };
      ASSERT_NE(clock.add(at(now), at(now + to + back), reader_clock(now + to)), Outcome::stepped);
      const hal::Duration later = now + to + back + 3s;
      const auto error = clock.to_instant(reader_clock(later), {}) - at(later);
      ASSERT_LE(std::abs(error.count()), (clock.uncertainty(at(later)) + 2ms).count());
      now += 5s;
    }
  }
}

}  // namespace
}  // namespace forager::reader
