#include "mocks/gen2_beam_bound.hpp"

#include <gtest/gtest.h>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

void expect_above(const AntennaPattern& pattern, double looseness) {
  const BeamBound bound(pattern);
  hal::Random random(3);
  double over = 0.0;
  constexpr int kPoints = 200'000;
  for (int i = 0; i < kPoints; ++i) {
    hal::Vec3 p;
    p.x = random.normal();
    p.y = random.normal();
    p.z = random.normal();
    const double above = bound.bound(p, norm(p)) - pattern.power(p);
    ASSERT_GE(above, 0.0) << p.x << " " << p.y << " " << p.z;
    over += above / kPoints;
  }
  EXPECT_LT(over, looseness) << "so loose that it is good for nothing";
}

TEST(BeamBound, IsAboveTheBeamAndNotFarAbove) {
  expect_above({}, 0.01);
  expect_above(AntennaPattern::cosine_squared(0.3, 2.0), 0.01);
  expect_above(AntennaPattern::gaussian(1.2, 0.8), 0.01);
  expect_above(AntennaPattern::cosine_squared(hal::kPi, hal::kPi), 0.01);
}

TEST(BeamBound, HoldsOnTheAxesAtTheNullsAndForNoPlace) {
  const AntennaPattern pattern;
  const BeamBound bound(pattern);
  for (const hal::Vec3 p :
       {hal::Vec3{1, 0, 0}, hal::Vec3{0, 1, 0}, hal::Vec3{0, 0, 1}, hal::Vec3{-1, 0, 0},
        hal::Vec3{1e-300, 1, 0}, hal::Vec3{1e100, 1, 0}, hal::Vec3{0.342020143325669, 0.939692620785908, 0}})
    EXPECT_GE(bound.bound(p, norm(p)), pattern.power(p)) << p.x;
  EXPECT_EQ(bound.bound({0, 0, 0}, 0.0), 0.0);
}

TEST(BeamBound, MeasuredCutsHaveNone) {
  const auto table = AntennaPattern::table({{-3.0, 0.5}, {3.0, 0.5}}, {{-1.0, 0.5}, {1.0, 0.5}});
  ASSERT_TRUE(table);
  EXPECT_EQ(BeamBound(*table).bound({-1.0, 0.0, 0.0}, 1.0), 1.0);
}

}  // namespace
}  // namespace forager::mocks
