#include "flight/dshot.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bitset>
#include <cmath>
#include <set>

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

// The checksum once more, the way firmware does it: three shifts in a loop.
unsigned firmware_checksum(unsigned twelve) {
  unsigned sum = 0;
  for (int i = 0; i < 3; ++i) {
    sum ^= twelve;
    twelve >>= 4U;
  }
  return sum & 0xFU;
}

TEST(Dshot, EncodesTheWordOfTheSpecification) {
  EXPECT_EQ(dshot_word(1046, false), 0x82C6);
  EXPECT_EQ(dshot_word(0, false), 0x0000);
  static_assert(dshot_word(1046, false) == 0x82C6);
}

TEST(Dshot, SetsTheTelemetryBitAndAllowsForItInTheChecksum) {
  EXPECT_EQ(dshot_word(1046, true), 0x82D7);
  EXPECT_EQ(dshot_word(2047, true), 0xFFFF);
}

TEST(Dshot, InvertsTheChecksumWhereTheLineIsInverted) {
  for (unsigned value = 0; value <= kDshotLastThrottle; ++value) {
    const auto v = static_cast<std::uint16_t>(value);
    const std::uint16_t normal = dshot_word(v, false);
    EXPECT_EQ(normal & 0xFU, firmware_checksum(normal >> 4U)) << value;
    EXPECT_EQ(dshot_word(v, false, DshotKind::bidirectional), normal ^ 0xFU) << value;
    EXPECT_EQ(normal >> 5U, value);
  }
}

TEST(Dshot, AnyOneWrongBitShowsInTheChecksum) {
  for (unsigned value = 0; value <= kDshotLastThrottle; ++value) {
    const unsigned word = dshot_word(static_cast<std::uint16_t>(value), (value % 2) != 0);
    for (unsigned bit = 0; bit < 16; ++bit) {
      const unsigned bad = word ^ (1U << bit);
      EXPECT_NE(bad & 0xFU, firmware_checksum(bad >> 4U));
    }
  }
}

TEST(Dshot, BitsLastAsLongAsTheRateSays) {
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot150).bit, 6667ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot300).bit, 3333ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot600).bit, 1667ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot1200).bit, 833ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot600).one_high, 1250ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot600).zero_high, 625ns);
  EXPECT_EQ(dshot_bit_times(DshotRate::dshot300).one_high, 2500ns);
  EXPECT_EQ(dshot_frame_time(DshotRate::dshot600), 26667ns);
}

TEST(Dshot, ThrottleNeverBecomesACommand) {
  DshotEncoder encoder;
  std::set<unsigned> seen;
  for (int i = 0; i <= 4000; ++i) {
    const double fraction = i / 4000.0;
    const unsigned value = encoder.throttle(fraction, false).value() >> 5U;
    EXPECT_TRUE(value == 0 || (value >= 48 && value <= 2047)) << fraction;
    EXPECT_EQ(value == 0, i == 0) << "only zero stops";
    seen.insert(value);
  }
  EXPECT_EQ(seen.size(), 2001U) << "every throttle value can be reached";
  EXPECT_EQ(encoder.throttle(1e-9, false).value() >> 5U, 48U);
  EXPECT_EQ(encoder.throttle(1.0, false).value() >> 5U, 2047U);
}

TEST(Dshot, RefusesCommandsWhileTheMotorRuns) {
  DshotEncoder encoder;
  ASSERT_TRUE(encoder.throttle(0.3, false));
  const auto refused = encoder.command(DshotCommand::direction_reversed);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, hal::ErrorCode::invalid_state);
  EXPECT_EQ(encoder.stop(), 0);
  const auto taken = encoder.command(DshotCommand::direction_reversed);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->word >> 5U, 21U);
  EXPECT_GE(taken->repeats, 6);
}

TEST(Dshot, ThrottleThatIsNoneChangesNothing) {
  DshotEncoder encoder;
  for (const double bad : {-0.01, 1.01, std::nan(""), HUGE_VAL}) {
    const auto refused = encoder.throttle(bad, false);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, hal::ErrorCode::invalid_argument);
  }
  EXPECT_FALSE(encoder.running());
}

RC_GTEST_PROP(Dshot, MoreThrottleNeverGivesLess, (double a, double b)) {
  const auto unit = [](double x) { return std::isfinite(x) ? std::abs(std::fmod(x, 1.0)) : 0.5; };
  DshotEncoder encoder;
  const auto low = encoder.throttle(std::min(unit(a), unit(b)), false);
  const auto high = encoder.throttle(std::max(unit(a), unit(b)), false);
  RC_ASSERT(low && high && (*low >> 5U) <= (*high >> 5U));
}

}  // namespace
}  // namespace forager::flight
