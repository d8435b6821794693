#include "mocks/gen2_field_fade.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

constexpr double kLength_m = 0.17;

double correlation_over(double distance_m, hal::Vec3 direction) {
  const FrozenFade fade(6.0, kLength_m, 42);
  hal::Random random(3);
  double sa = 0.0;
  double sb = 0.0;
  double saa = 0.0;
  double sbb = 0.0;
  double sab = 0.0;
  constexpr int kPlaces = 20000;
  for (int i = 0; i < kPlaces; ++i) {
    const hal::Vec3 at{random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), random.uniform(0.5, 2.0)};
    const double a = fade.amplitude(7, 1, at);
    const double b = fade.amplitude(7, 1, at + distance_m * direction);
    sa += a;
    sb += b;
    saa += a * a;
    sbb += b * b;
    sab += a * b;
  }
  const double n = kPlaces;
  return (sab / n - sa * sb / n / n) / std::sqrt((saa / n - sa * sa / n / n) * (sbb / n - sb * sb / n / n));
}

TEST(FrozenFade, KeepsPowerOneOnAverageWhateverTheK) {
  for (const double k_db : {-10.0, 0.0, 6.0, 12.0}) {
    const FrozenFade fade(k_db, kLength_m, 1);
    double power = 0.0;
    for (std::uint32_t tag = 0; tag < 20000; ++tag) {
      const double a = fade.amplitude(tag, 2, {0.31, 0.77, 1.2});
      EXPECT_LE(a, fade.max_amplitude());
      power += a * a;
    }
    // Rayleigh power has deviation 1: 0.7 % for 20000 tags; the cut takes up to 1 %.
    EXPECT_NEAR(power / 20000.0, 1.0, 0.03) << k_db;
  }
}

TEST(FrozenFade, ForgetsItselfOverHalfAWavelength) {
  for (const hal::Vec3 direction :
       {hal::Vec3{1.0, 0.0, 0.0}, hal::Vec3{0.6, 0.8, 0.0}, hal::Vec3{0.0, 0.0, 1.0}}) {
    EXPECT_GT(correlation_over(0.1 * kLength_m, direction), 0.9);
    EXPECT_LT(std::abs(correlation_over(kLength_m, direction)), 0.3);
    EXPECT_LT(std::abs(correlation_over(2.0 * kLength_m, direction)), 0.04);
  }
}

TEST(FrozenFade, IsFrozenAndDiffersBetweenTagsPortsAndSeeds) {
  const FrozenFade fade(0.0, kLength_m, 1);
  const hal::Vec3 here{1.0, -2.0, 1.1};
  EXPECT_EQ(fade.amplitude(3, 1, here), FrozenFade(0.0, kLength_m, 1).amplitude(3, 1, here));
  EXPECT_NE(fade.amplitude(3, 1, here), fade.amplitude(4, 1, here));
  EXPECT_NE(fade.amplitude(3, 1, here), fade.amplitude(3, 2, here));
  EXPECT_NE(fade.amplitude(3, 1, here), FrozenFade(0.0, kLength_m, 2).amplitude(3, 1, here));
  // Continuous: a tenth of a millimetre changes little.
  EXPECT_NEAR(fade.amplitude(3, 1, here), fade.amplitude(3, 1, here + hal::Vec3{1e-4, 0.0, 0.0}), 0.01);
}

TEST(FrozenFade, CanBeSwitchedOff) {
  const FrozenFade fade(FrozenFade::kNoFade_db, kLength_m, 1);
  EXPECT_EQ(fade.amplitude(3, 1, {1.0, 2.0, 3.0}), 1.0);
  EXPECT_EQ(fade.max_amplitude(), 1.0);
}

}  // namespace
}  // namespace forager::mocks
