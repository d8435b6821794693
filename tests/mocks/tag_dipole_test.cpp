#include "mocks/tag_dipole.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::mocks {
namespace {

TEST(TagDipole, TakesUpWhatAHalfWaveDipoleDoes) {
  EXPECT_EQ(dipole_power(0.0), 1.0);
  EXPECT_EQ(dipole_power(1.0), 0.0);
  EXPECT_EQ(dipole_power(-1.0), 0.0);
  // Half power 39 degrees off broadside: a beamwidth of 78 degrees.
  EXPECT_NEAR(dipole_power(std::sin(hal::deg_to_rad(39.0))), 0.5, 0.01);
  // Directivity 1.643 (2.16 dBi): the mean over the sphere is 1 over it. Midpoints over the even cosine.
  double sum = 0.0;
  for (int i = 0; i < 20000; ++i) sum += dipole_power((i + 0.5) / 10000.0 - 1.0);
  EXPECT_NEAR(20000.0 / sum, 1.6409, 1e-3);
}

TEST(TagDipole, LosesNoDigitNextToItsAxis) {
  // (pi/2)^2 rest / 2 to first order.
  for (double rest = 1e-3; rest > 1e-15; rest /= 10.0) {
    const double c = 1.0 - rest;
    EXPECT_NEAR(dipole_power(c) / (hal::kPi * hal::kPi / 8.0 * (1.0 - c)), 1.0, 1e-3 + rest) << rest;
  }
}

TEST(TagDipole, WhatIsNoDirectionIsDeaf) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double c : {nan, 1.0 + 1e-16, 2.0, HUGE_VAL, -HUGE_VAL}) EXPECT_EQ(dipole_power(c), 0.0);
  const TagDipoles upright{.axes = TagAxes::upright};
  EXPECT_EQ(orientation_power(upright, 1, {0.0, 0.0, 0.0}, 1), 0.0);
  EXPECT_EQ(orientation_power(upright, 1, {nan, 0.0, 0.0}, 1), 0.0);
}

TEST(TagDipole, OffByDefault) { EXPECT_EQ(orientation_power({}, 5, {0.0, 0.0, 2.0}, 1), 1.0); }

TEST(TagDipole, ACircularAntennaLosesHalfThePowerToALinearTag) {
  const TagDipoles upright{.axes = TagAxes::upright};
  EXPECT_NEAR(orientation_power(upright, 5, {3.0, 0.0, 0.0}, 1), 0.5, 1e-5);
  EXPECT_NEAR(
      orientation_power({.axes = TagAxes::upright, .polarisation_loss_db = 0.0}, 5, {0.0, 3.0, 0.0}, 1), 1.0,
      1e-15);
  EXPECT_EQ(orientation_power(upright, 5, {0.0, 0.0, -3.0}, 1), 0.0);
}

TEST(TagDipole, ScatteredAxesAreEvenAndTheTagsOwn) {
  hal::Vec3 mean;
  double squares = 0.0;
  constexpr int kTags = 20000;
  for (std::uint32_t tag = 0; tag < kTags; ++tag) {
    const hal::Vec3 axis = dipole_axis(TagAxes::scattered, tag, 7);
    ASSERT_NEAR(hal::norm(axis), 1.0, 1e-15);
    mean = mean + (1.0 / kTags) * axis;
    squares += axis.z * axis.z / kTags;
  }
  EXPECT_LT(hal::norm(mean), 0.03);  // 4 standard errors
  EXPECT_NEAR(squares, 1.0 / 3.0, 0.01);
  EXPECT_EQ(dipole_axis(TagAxes::scattered, 3, 7), dipole_axis(TagAxes::scattered, 3, 7));
  EXPECT_FALSE(dipole_axis(TagAxes::scattered, 3, 7) == dipole_axis(TagAxes::scattered, 3, 8));
}

}  // namespace
}  // namespace forager::mocks
