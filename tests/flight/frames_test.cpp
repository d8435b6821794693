#include "flight/frames.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace forager::flight {
namespace {

using hal::kPi;
using hal::Vec3;

void expect_near(Vec3 a, Vec3 b, double tolerance = 1e-12) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Frames, LeftAndUpBecomeRightAndDown) {
  EXPECT_EQ(flip_yz({1, 2, 3}), (Vec3{1, -2, -3}));
  EXPECT_EQ(flip_yz(flip_yz({1, 2, 3})), (Vec3{1, 2, 3}));
}

TEST(Frames, ATurnToTheLeftIsNegativeForTheAutopilot) {
  EXPECT_DOUBLE_EQ(flip_angle(0.5), -0.5);
  EXPECT_DOUBLE_EQ(flip_angle(0.0), 0.0);
}

TEST(Frames, FacingBackStaysPlusPiInBothFamilies) {
  EXPECT_EQ(flip_angle(kPi), kPi);
  EXPECT_EQ(flip_angle(-kPi), kPi);
  EXPECT_NEAR(flip_angle(std::nextafter(kPi, 0.0)), -kPi, 1e-12);
  EXPECT_GT(flip_angle(std::nextafter(kPi, 0.0)), -kPi);
}

TEST(Frames, PoseKeepsRollAndNegatesPitchAndYaw) {
  const hal::Pose ned = flip_pose({{1, 2, 3}, 0.3, 0.2, -0.1});
  EXPECT_EQ(ned.position, (Vec3{1, -2, -3}));
  EXPECT_DOUBLE_EQ(ned.yaw_rad, -0.3);
  EXPECT_DOUBLE_EQ(ned.pitch_rad, -0.2);
  EXPECT_DOUBLE_EQ(ned.roll_rad, -0.1);
}

// The defining property: a body vector seen in the world is the same arrow in both families.
RC_GTEST_PROP(FramesProperty, FlippedAttitudeTurnsFlippedVectors, ()) {
  const auto angle = [] { return *rc::gen::inRange(-3141, 3142) * 1e-3; };
  const hal::Pose pose{{}, angle(), angle() / 2, angle()};
  const Vec3 arrow{angle(), angle(), angle()};
  const Vec3 ours = flip_yz(rotation_of(pose) * arrow);
  const Vec3 theirs = rotation_of(flip_pose(pose)) * flip_yz(arrow);
  RC_ASSERT(hal::norm(ours - theirs) < 1e-12);
}

RC_GTEST_PROP(FramesProperty, AnglesSurviveTheMatrix, ()) {
  const auto angle = [](int limit) { return *rc::gen::inRange(-limit, limit) * 1e-3; };
  const hal::Pose pose{{1, 2, 3}, angle(3141), angle(1570), angle(3141)};
  const hal::Pose back = pose_from(pose.position, rotation_of(pose));
  RC_ASSERT(std::abs(hal::angle_difference(back.yaw_rad, pose.yaw_rad)) < 1e-9);
  RC_ASSERT(std::abs(back.pitch_rad - pose.pitch_rad) < 1e-9);
  RC_ASSERT(std::abs(hal::angle_difference(back.roll_rad, pose.roll_rad)) < 1e-9);
}

TEST(Frames, LookingStraightDownGivesAFiniteHeading) {
  const hal::Pose down{{}, 0.7, kPi / 2, 0.0};  // positive pitch lowers the nose
  const hal::Pose back = pose_from({}, rotation_of(down));
  EXPECT_NEAR(back.pitch_rad, kPi / 2, 1e-7);
  EXPECT_NEAR(back.yaw_rad, 0.7, 1e-9);
  EXPECT_EQ(back.roll_rad, 0.0);
}

TEST(Frames, PositiveYawTurnsTheNoseLeftAndPositivePitchLowersIt) {
  expect_near(rotation_of({{}, kPi / 2, 0, 0}) * Vec3{1, 0, 0}, {0, 1, 0});
  expect_near(rotation_of({{}, 0, kPi / 2, 0}) * Vec3{1, 0, 0}, {0, 0, -1});
  expect_near(rotation_of({{}, 0, 0, kPi / 2}) * Vec3{0, 1, 0}, {0, 0, 1});
}

TEST(Frames, MountIsTakenOut) {
  // Camera 0.2 m ahead of the body's centre, looking down; the body stands at (5, 1, 2) facing left.
  const hal::Pose mount{{0.2, 0, 0}, 0, kPi / 2, 0};
  const hal::Pose body{{5, 1, 2}, kPi / 2, 0.1, 0};
  const hal::Pose camera =
      pose_from(body.position + rotation_of(body) * mount.position, rotation_of(body) * rotation_of(mount));
  const hal::Pose found = take_out_mount(camera, mount);
  expect_near(found.position, body.position, 1e-9);
  EXPECT_NEAR(found.yaw_rad, body.yaw_rad, 1e-9);
  EXPECT_NEAR(found.pitch_rad, body.pitch_rad, 1e-9);
  EXPECT_NEAR(found.roll_rad, 0.0, 1e-9);
}

}  // namespace
}  // namespace forager::flight
