#include "hal/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace forager::hal {
namespace {

using Numbers = std::vector<std::uint64_t>;

Numbers draw(Random random, int count) {
  Numbers out;
  for (int i = 0; i < count; ++i) out.push_back(random.next());
  return out;
}

// Computed with arbitrary-precision integers from the published xoshiro256** and splitmix64 definitions,
// after that computation gave the published outputs 11520, 0, 1509978240, 1215971899390074240 for state 1, 2,
// 3, 4 and 6457827717110365317 for splitmix64 seeded with 1234567.
TEST(Random, GivesThePublishedSequence) {
  EXPECT_EQ((Numbers{0x99ec5f36cb75f2b4, 0xbf6e1f784956452a, 0x1a5f849d4933e6e0, 0x6aa594f1262d2d2c}),
            draw(Random(0), 4));
  EXPECT_EQ((Numbers{0x15780b2e0c2ec716, 0x6104d9866d113a7e, 0xae17533239e499a1, 0xecb8ad4703b360a1}),
            draw(Random(42), 4));
  EXPECT_EQ((Numbers{0x8f5520d52a7ead08, 0xc476a018caa1802d}), draw(Random(~std::uint64_t{0}), 2));
}

TEST(Random, StreamsOfOneSeedAreFixedAndDifferent) {
  EXPECT_EQ((Numbers{0x2a9c1e543d8650ab, 0x5210545a16c87c88}), draw(Random::stream(42, 0), 2));
  EXPECT_EQ((Numbers{0x5020ea8d9857825a, 0xa94a57e60b24f143}), draw(Random::stream(42, 1), 2));
  EXPECT_EQ((Numbers{0x930fc063e3654fcd, 0x6abf8f4c453d40b8}), draw(Random::stream(43, 0), 2));
}

TEST(Random, UniformFillsItsRangeEvenly) {
  Random random(7);
  std::array<int, 10> bins{};
  for (int i = 0; i < 100'000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    ASSERT_GE(x, -2.0);
    ASSERT_LT(x, 3.0);
    ++bins[static_cast<std::size_t>((x + 2.0) * 2.0)];
  }
  // Binomial(100000, 0.1): one standard deviation is 95.
  for (const int count : bins) EXPECT_NEAR(10'000, count, 5 * 95);
}

TEST(Random, NormalHasItsMomentsAndTails) {
  Random random(8);
  constexpr int kDraws = 200'000;
  double sum = 0.0;
  double squares = 0.0;
  double cubes = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    cubes += x * x * x;
    if (std::abs(x) > 2.0) ++beyond_two;
  }
  EXPECT_NEAR(0.0, sum / kDraws, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(1.0, squares / kDraws, 5.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(0.0, cubes / kDraws, 5.0 * std::sqrt(15.0 / kDraws));
  EXPECT_NEAR(0.0455, static_cast<double>(beyond_two) / kDraws, 0.0025);
}

TEST(Random, ExponentialHasMeanOneAndNoMemory) {
  Random random(9);
  constexpr int kDraws = 200'000;
  double sum = 0.0;
  int beyond_one = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.exponential();
    ASSERT_GE(x, 0.0);
    sum += x;
    beyond_one += x > 1.0 ? 1 : 0;
    beyond_two += x > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(1.0, sum / kDraws, 5.0 / std::sqrt(kDraws));
  EXPECT_NEAR(std::exp(-1.0), static_cast<double>(beyond_two) / beyond_one, 0.01);
}

TEST(Random, ChanceNeverAndAlways) {
  Random random(10);
  for (int i = 0; i < 10'000; ++i) {
    ASSERT_FALSE(random.chance(0.0));
    ASSERT_TRUE(random.chance(1.0));
    ASSERT_LT(random.below(3), 3U);
  }
}

}  // namespace
}  // namespace forager::hal
