#include "flight/relative_pose.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "hal/random.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

MapPoint turned(MapPoint a, double by_rad) {
  const double c = std::cos(by_rad);
  const double s = std::sin(by_rad);
  return {c * a.x_m - s * a.y_m, s * a.x_m + c * a.y_m};
}
MapPoint plus(MapPoint a, MapPoint b) { return {a.x_m + b.x_m, a.y_m + b.y_m}; }
MapPoint minus(MapPoint a, MapPoint b) { return {a.x_m - b.x_m, a.y_m - b.y_m}; }

// Both robots at the origin of their maps.
MutualSighting sighting(MapPoint p, MapPoint q) { return {{}, p, {}, q}; }
MutualSighting exact_sighting(MapPoint p, double phi_deg) {
  return sighting(p, turned({-p.x_m, -p.y_m}, -hal::deg_to_rad(phi_deg)));
}

TEST(RelativePose, EveryAngleComesBack) {
  for (const double phi_deg : {0.0, 30.0, 90.0, -90.0, 120.0, 135.0, 180.0, -135.0}) {
    const RelativePose pose = relative_pose(exact_sighting({1.0, 0.65}, phi_deg), {});
    EXPECT_EQ(pose.rejection, PoseRejection::none);
    EXPECT_NEAR(hal::rad_to_deg(std::abs(pose.phi_rad)), std::abs(phi_deg), 1e-13) << phi_deg;
    EXPECT_NEAR(hal::angle_difference(pose.phi_rad, hal::deg_to_rad(phi_deg)), 0.0, 1e-15) << phi_deg;
  }
  EXPECT_EQ(relative_pose(exact_sighting({1.0, 0.65}, 0.0), {}).phi_rad, 0.0);
}

TEST(RelativePose, MeasuredPositionsGiveTheMeasuredAngle) {
  const RelativePose pose = relative_pose(sighting({1.0, 0.25}, {-0.27, 1.02}), {});
  EXPECT_NEAR(hal::rad_to_deg(pose.phi_rad), 89.2098, 5e-5);
}

TEST(RelativePose, FacingEachOtherIsPlusPi) {
  EXPECT_EQ(relative_pose(sighting({1.0, 0.0}, {1.0, 0.0}), {}).phi_rad, hal::kPi);
  EXPECT_EQ(relative_pose(sighting({1.0, 0.0}, {1.0, -0.0}), {}).phi_rad, hal::kPi);
}

TEST(RelativePose, SigmaFallsWithTheDistance) {
  const RelativePoseConfig config{.sigma_position_m = 0.02};
  EXPECT_DOUBLE_EQ(relative_pose(exact_sighting({2.0, 0.0}, 10.0), config).sigma_phi_rad,
                   std::sqrt(2.0) * 0.01);
}

// The stated sigma is that of the angle when both sightings are noisy.
TEST(RelativePose, SigmaIsWhatNoiseDoes) {
  hal::Random random(5);
  const RelativePoseConfig config{.distance_tolerance_m = 1.0, .sigma_position_m = 0.02};
  double squares = 0.0;
  double stated = 0.0;
  constexpr int kRuns = 4000;
  for (int i = 0; i < kRuns; ++i) {
    MutualSighting s = exact_sighting({1.5, 0.4}, 70.0);
    for (MapPoint* seen : {&s.pawn_seen, &s.detector_seen})
      *seen = plus(*seen, {0.02 * random.normal(), 0.02 * random.normal()});
    const RelativePose pose = relative_pose(s, config);
    squares += std::pow(hal::angle_difference(pose.phi_rad, hal::deg_to_rad(70.0)), 2);
    stated = pose.sigma_phi_rad;
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns) / stated, 1.0, 0.05);  // 4.5 standard errors
}

TEST(RelativePose, RejectsWithAReason) {
  const auto why = [](MapPoint p, MapPoint q) { return relative_pose(sighting(p, q), {}).rejection; };
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(why({1.0, 0.0}, {-1.16, 0.0}), PoseRejection::distances_differ);
  EXPECT_EQ(why({1.0, 0.0}, {-1.14, 0.0}), PoseRejection::none);
  EXPECT_EQ(why({0.29, 0.0}, {-0.29, 0.0}), PoseRejection::too_near);
  EXPECT_EQ(why({0.0, 0.0}, {0.0, 0.0}), PoseRejection::too_near);
  EXPECT_EQ(why({inf, 0.0}, {-inf, 0.0}), PoseRejection::not_finite);
  EXPECT_EQ(why({nan, 0.0}, {-1.0, 0.0}), PoseRejection::not_finite);
  EXPECT_EQ(why({inf, nan}, {1.0, 0.0}), PoseRejection::not_finite);  // hypot(inf, nan) is inf
  EXPECT_EQ(why({1.0, 0.0}, {0.0, 0.0}), PoseRejection::distances_differ);
}

TEST(RelativePose, CoincidentRobotsHaveNoAngleWhateverTheLimits) {
  const RelativePoseConfig anything{.distance_tolerance_m = 1e9, .min_distance_m = 0.0};
  EXPECT_EQ(relative_pose(sighting({0, 0}, {1, 0}), anything).rejection, PoseRejection::too_near);
  EXPECT_EQ(relative_pose(sighting({1, 0}, {0, 0}), anything).rejection, PoseRejection::too_near);
}

// Anywhere, with any distance between the maps' origins: the pose takes what the Pawn knows into the
// Detector's frame.
RC_GTEST_PROP(RelativePoseProperty, TakesPointsFromOneMapToTheOther, (std::uint64_t seed)) {
  hal::Random random(seed);
  const auto place = [&](double size) {
    return MapPoint{random.uniform(-size, size), random.uniform(-size, size)};
  };
  const double phi = random.uniform(-hal::kPi, hal::kPi);
  const MapPoint t = place(100.0);
  const MapPoint pawn = place(50.0);       // in its own map
  const MapPoint detector = place(200.0);  // in its own map
  const auto to_detector = [&](MapPoint s) { return plus(turned(s, phi), t); };
  const MutualSighting s{detector, to_detector(pawn), pawn, turned(minus(detector, t), -phi)};
  const RelativePose pose = relative_pose(s, {.distance_tolerance_m = 1e-9, .min_distance_m = 0.1});
  RC_PRE(pose.rejection != PoseRejection::too_near);
  RC_ASSERT(pose.rejection == PoseRejection::none);
  const double lever_m = 1e-13 / pose.distance_m;  // rounding of the inputs, 200 m, turns the line of sight
  RC_ASSERT(std::abs(hal::angle_difference(pose.phi_rad, phi)) <= 1e-15 + 2.0 * lever_m);
  const MapPoint known = place(50.0);
  const MapPoint moved = plus(turned(known, pose.phi_rad), pose.translation);
  const MapPoint error = minus(moved, to_detector(known));
  RC_ASSERT(std::hypot(error.x_m, error.y_m) <= 1e-12 + 400.0 * lever_m);
}

}  // namespace
}  // namespace forager::flight
