#include "flight/omni_mixing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

TEST(OmniMixing, ForwardMakesTheRearMotorsFaster) {
  const OmniShares s = omni_mix(0.4, 0.1, 0.0);
  EXPECT_GT(s.rear_left, s.front_left);
  EXPECT_DOUBLE_EQ(s.rear_left, s.rear_right);
  EXPECT_DOUBLE_EQ(s.front_left, s.front_right);
}

TEST(OmniMixing, ReverseMakesTheFrontMotorsFaster) {
  const OmniShares s = omni_mix(0.4, -0.1, 0.0);
  EXPECT_GT(s.front_left, s.rear_left);
  EXPECT_DOUBLE_EQ(s.front_left, s.front_right);
}

TEST(OmniMixing, RotationMakesOneDiagonalFaster) {
  const OmniShares left = omni_mix(0.4, 0.0, 0.1);
  EXPECT_DOUBLE_EQ(left.front_left, left.rear_right);
  EXPECT_DOUBLE_EQ(left.front_right, left.rear_left);
  EXPECT_GT(left.front_left, left.front_right) << "clockwise rotors turn the body to the left";
  const OmniShares right = omni_mix(0.4, 0.0, -0.1);
  EXPECT_GT(right.front_right, right.front_left);
}

TEST(OmniMixing, WhatIsNotKnownPushesNothing) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    EXPECT_EQ(omni_mix(bad, 0.0, 0.0).total(), 0.0);
    EXPECT_EQ(omni_mix(0.4, bad, 0.0).total(), 0.0);
    EXPECT_EQ(omni_drive(0.1, bad, {}, {}).total(), 0.0);
    EXPECT_EQ(omni_drive(0.1, 0.0, {.pitch_rad = bad}, {}).total(), 0.0);
  }
}

RC_GTEST_PROP(OmniMixing, TheSumIsConstantHoweverMuchIsAskedFor, (std::uint64_t seed)) {
  hal::Random random(seed);
  const double thrust = random.uniform(0.0, 1.0);
  const double size = std::pow(10.0, random.uniform(-6.0, 6.0));
  const double pitch = random.uniform(-size, size);
  const double yaw = random.uniform(-size, size);
  const OmniShares s = omni_mix(thrust, pitch, yaw);
  RC_ASSERT(std::abs(s.total() - 4.0 * thrust) < 1e-14);
  for (const double share : {s.front_left, s.front_right, s.rear_left, s.rear_right})
    RC_ASSERT(share >= 0.0 && share <= 1.0);
  // The direction of the motion is kept: the pairs differ in the proportion asked for.
  const double got_pitch = (s.rear_left + s.rear_right - s.front_left - s.front_right) / 4.0;
  const double got_yaw = (s.front_left + s.rear_right - s.front_right - s.rear_left) / 4.0;
  RC_ASSERT(std::abs(got_pitch * yaw - got_yaw * pitch) <= 1e-14 * (std::abs(pitch) + std::abs(yaw)));
}

// The platform as a rigid body that the shares drive: alpha tilts, K_T sin(alpha) pushes against rolling
// drag, the diagonals turn it.
struct Platform {
  double pitch = 0.0, pitch_rate = 0.0, yaw = 0.0, yaw_rate = 0.0, speed = 0.0, x = 0.0, y = 0.0;
  void step(const OmniShares& s, double dt) {
    constexpr double kMass = 6.0, kMotor_n = 13.0, kArm_m = 0.2, kInertia = 0.05, kTurnInertia = 0.3;
    const double moment = kMotor_n * kArm_m * (s.rear_left + s.rear_right - s.front_left - s.front_right);
    const double turn = 0.25 * kMotor_n * (s.front_left + s.rear_right - s.front_right - s.rear_left);
    pitch_rate += dt * (moment - 0.3 * pitch_rate) / kInertia;
    pitch += dt * pitch_rate;
    yaw_rate += dt * (turn - 0.2 * yaw_rate) / kTurnInertia;
    yaw += dt * yaw_rate;
    const OmniForces forces = omni_forces(kMotor_n * s.total(), pitch, kMass);
    EXPECT_GT(forces.normal_n, 0.3 * kMass * 9.80665) << "the wheels keep their grip";
    speed += dt * (forces.forward_n - 0.6 * speed) / kMass;
    x += dt * speed * std::cos(yaw);
    y += dt * speed * std::sin(yaw);
  }
  void drive(double alpha, double beta, double seconds) {
    for (double t = 0.0; t < seconds; t += 0.005)
      step(omni_drive(alpha, beta, {pitch, pitch_rate, yaw, yaw_rate}, OmniConfig{}), 0.005);
  }
};

TEST(OmniDrive, RollsForwardAndBackByTheTilt) {
  Platform platform;
  platform.drive(hal::deg_to_rad(10.0), 0.0, 3.0);
  EXPECT_NEAR(platform.pitch, hal::deg_to_rad(10.0), 0.01);
  EXPECT_GT(platform.x, 1.0);
  EXPECT_NEAR(platform.y, 0.0, 1e-9);
  const double farthest = platform.x;
  platform.drive(hal::deg_to_rad(-10.0), 0.0, 6.0);
  EXPECT_LT(platform.speed, 0.0);
  EXPECT_LT(platform.x, farthest + 2.0);
}

TEST(OmniDrive, TurnsToTheHeadingTheShortWay) {
  for (const double beta : {0.5, -0.5, 1.6, hal::kPi - 0.1}) {
    Platform platform;
    platform.yaw = 0.0;
    platform.drive(0.0, beta, 12.0);
    EXPECT_NEAR(platform.yaw, beta, 0.02) << beta;
    EXPECT_NEAR(std::hypot(platform.x, platform.y), 0.0, 0.02) << "it turns where it stands";
  }
  Platform wrapped;
  wrapped.yaw = hal::kPi - 0.05;
  wrapped.drive(0.0, -hal::kPi + 0.05, 12.0);
  EXPECT_NEAR(wrapped.yaw, hal::kPi + 0.05, 0.02) << "0.1 rad to the left, not a round to the right";
}

TEST(OmniConfig, RefusesWhatLiftsOrTipsIt) {
  EXPECT_TRUE(validate(OmniConfig{}, 0.5));
  EXPECT_FALSE(validate(OmniConfig{.thrust = 0.6}, 0.5)) << "no weight left on the wheels";
  EXPECT_FALSE(validate(OmniConfig{.thrust = 0.0}, 0.5));
  EXPECT_FALSE(validate(OmniConfig{.max_alpha_rad = 1.0}, 0.5));
  EXPECT_FALSE(validate(OmniConfig{.pitch_gain = -1.0}, 0.5));
  EXPECT_FALSE(validate(OmniConfig{.yaw_gain = std::nan("")}, 0.5));
  EXPECT_FALSE(validate(OmniConfig{.max_yaw = 2.0}, 0.5));
}

}  // namespace
}  // namespace forager::flight
