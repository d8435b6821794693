#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "boards/planner_truth.hpp"
#include "boards/stress_case.hpp"
#include "flight/frames.hpp"
#include "flight/obstacle_guard.hpp"
#include "flight/relative_pose.hpp"

// Where geometry in floating point usually breaks: tangents to a circle from beside it, needle-like
// triangles, angles near 0, 90, 180 and 360 degrees, wraps, and lengths whose squares are no doubles.
namespace forager::boards {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

servo::TurnPlan planned(servo::Target target, double half_track_m = 0.5) {
  const auto plan = servo::plan_turn_then_drive(target, {.half_track_m = half_track_m});
  return plan ? *plan : servo::TurnPlan{.chosen = {.turn_rad = kNaN, .drive_m = kNaN}};
}

// The length of the tangent from a point r (1 + e) from the centre: sqrt(d^2 - r^2) keeps 3 digits of it at
// e = 1e-14.
StressCase tangent() {
  Worst worst;
  for (const double e : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14, 1e-15})
    for (const double bearing : {-1.4, -0.3, 0.2, 1.2, 2.9}) {
      const double d = 0.5 * (1.0 + e);
      const servo::Target target{d * std::cos(bearing), 0.5 + d * std::sin(bearing)};
      const Wide x(target.x_m);
      const Wide y(target.y_m);
      const Wide q = x * x + y * (y - Wide(1.0));
      if (q.high > 0.0) worst.relative(planned(target).left.drive_m, sqrt(q).rounded());
    }
  return worst.against("turn-then-drive: tangent from beside the pivot circle, relative", 3e-16);
}

StressCase on_the_circle() {
  Worst worst;
  for (const servo::Target target :
       {servo::Target{0.5, 0.5}, {-0.5, 0.5}, {0.0, 1.0}, {0.0, 0.5}, {0.0, 0.0}})
    for (const double dx : {-kInf, 0.0, kInf})
      for (const double dy : {-kInf, 0.0, kInf}) {
        const servo::Target beside{dx == 0.0 ? target.x_m : std::nextafter(target.x_m, dx),
                                   dy == 0.0 ? target.y_m : std::nextafter(target.y_m, dy)};
        const servo::TurnPlan plan = planned(beside);
        for (const servo::TurnThenDrive& way : {plan.left, plan.right})
          worst.must(way.turn_rad >= 0.0 && way.turn_rad <= 2.0 * hal::kPi && way.drive_m >= 0.0);
      }
  return worst.against("turn-then-drive: on the circle, on the wheel, one unit beside", 0.0);
}

StressCase half_tracks_without_meaning() {
  Worst worst;
  for (const double r : {0.0, -0.0, -0.5, 5e-324, 1e300, kInf, -kInf, kNaN})
    worst.must(!servo::plan_turn_then_drive({1.0, 0.5}, {.half_track_m = r}));
  for (const double x : {kInf, -kInf, kNaN}) worst.must(!servo::plan_turn_then_drive({x, 0.5}, {}));
  return worst.against("turn-then-drive: no half track, no target: refused", 0.0);
}

// Turns of 10^-k and of a whole circle less 10^-k.
StressCase slight_turns() {
  Worst worst;
  for (int k = 1; k <= 15; ++k) {
    const servo::Target target{2.0, 2.0 * std::pow(10.0, -k)};
    const auto plan = servo::plan_turn_then_drive(target, {.straight_band = 0.0});
    worst.must(plan.has_value());
    if (!plan) continue;
    for (const servo::TurnThenDrive& way : {plan->left, plan->right})
      worst.add(miss_m(way, 0.5, target, Rests::with) / target.y_m);
  }
  return worst.against("turn-then-drive: turns near 0 and 2 pi, miss over the offset to the side", 1e-15);
}

StressCase extreme_targets() {
  Worst worst;
  for (const double size : {5e-324, 1e-308, 1e-200, 1e-100, 1e100, 1e200, 1e307}) {
    worst.relative(planned({size, 0.0}).chosen.drive_m, size);
    worst.relative(planned({-size, -0.0}).chosen.drive_m, size);
  }
  worst.relative(planned({1e200, 1e200}).chosen.drive_m, std::sqrt(2.0) * 1e200);
  worst.relative(planned({0.0, 1e-200}).chosen.drive_m, 1e-100);  // sqrt(2 r Y)
  worst.must(planned({1.7e308, 1.7e308}).no_way == servo::NoWay::too_far);
  return worst.against("turn-then-drive: 5e-324 to 1e307 m, relative", 4e-16);
}

StressCase end_points() {
  Worst worst;
  hal::Random random(17);
  for (unsigned i = 0; i < 20'000; ++i) {
    const double r = any_half_track_m(random);
    const servo::Target target = hard_target(random, i, r);
    const servo::TurnPlan plan = planned(target, r);
    for (const servo::TurnThenDrive& way : {plan.left, plan.right})
      worst.add(miss_m(way, r, target, Rests::with) / distance_m(target));
  }
  return worst.against("turn-then-drive: 1e-12 to 1e6 m, end off, relative", 1e-12);
}

StressCase wraps() {
  Worst worst;
  const double pi = hal::kPi;
  for (const double angle : {pi, -pi, 3 * pi, -3 * pi, std::nextafter(-pi, 0.0), std::nextafter(-pi, -4.0),
                             std::nextafter(pi, 4.0), 1e5 * pi, 1e22, -1e22, 1e300, -0.0, 5e-324}) {
    const double wrapped = hal::wrap_pi(angle);
    worst.must(wrapped > -pi && wrapped <= pi && hal::wrap_pi(wrapped) == wrapped);
  }
  worst.must(hal::wrap_pi(-pi) == pi);
  worst.must(std::isnan(hal::wrap_pi(kInf)) && std::isnan(hal::wrap_pi(kNaN)));
  worst.near(hal::angle_difference(hal::deg_to_rad(-179.0), hal::deg_to_rad(179.0)), hal::deg_to_rad(2.0));
  return worst.against("angles: wrap half-open and idempotent, 179 to -179 is 2 degrees", 1e-15);
}

flight::RelativePose seen(flight::MapPoint p, flight::MapPoint q) {
  return flight::relative_pose({{}, p, {}, q}, {.distance_tolerance_m = 1e300, .min_distance_m = 0.0});
}

// The angle of almost collinear sightings, where an arccosine answers 0 below 1.5e-8, and near 90 and 180.
StressCase needle_sightings() {
  Worst worst;
  for (const double base : {0.0, 0.5, 1.0, -0.5})  // half turns
    for (int k = 1; k <= 300; k = k < 20 ? k + 1 : k + 40) {
      const WideDirection turn = direction(Wide(-base * hal::kPi));
      const flight::MapPoint p{1.0, 0.65 * std::pow(10.0, -k % 20)};
      const double slant = std::pow(10.0, -k);
      const flight::MapPoint q{(-turn.cos * Wide(p.x_m) + turn.sin * Wide(p.y_m + slant)).rounded(),
                               (-turn.sin * Wide(p.x_m) - turn.cos * Wide(p.y_m + slant)).rounded()};
      const Wide cross = Wide(p.x_m) * Wide(q.y_m) - Wide(p.y_m) * Wide(q.x_m);
      const Wide dot = Wide(p.x_m) * Wide(q.x_m) + Wide(p.y_m) * Wide(q.y_m);
      const double exact = atan2(cross, -dot).rounded();
      const double phi = seen(p, q).phi_rad;
      worst.add(std::abs(hal::angle_difference(phi, exact)) / std::max(std::abs(exact), 1e-300));
    }
  return worst.against("relative pose: needle-like sightings, relative", 4e-16);
}

StressCase sightings_of_any_length() {
  Worst worst;
  for (const double size : {5e-324, 1e-308, 1e-200, 1e-12, 1e6, 1e200, 1e300}) {
    worst.near(seen({size, 0.0}, {0.0, size}).phi_rad, hal::kPi / 2);
    worst.near(seen({size, 0.0}, {size, -0.0}).phi_rad, hal::kPi);  // atan2(-0, -1) is -pi
    worst.must(seen({kInf, kNaN}, {size, size}).rejection == flight::PoseRejection::not_finite);
    worst.must(seen({0.0, 0.0}, {size, size}).rejection == flight::PoseRejection::too_near);
  }
  return worst.against("relative pose: 5e-324 to 1e300 m, infinities, NaN", 3e-16);
}

StressCase looking_straight_up() {
  Worst worst;
  for (const double pitch : {-hal::kPi / 2, hal::kPi / 2, 1.5707963, -1.57079632679})
    for (const double yaw : {-3.0, 0.0, 0.7, 3.1}) {
      const flight::Rotation turn = flight::rotation_of({{}, yaw, pitch, 0.3});
      const flight::Rotation again = flight::rotation_of(flight::pose_from({}, turn));
      for (std::size_t i = 0; i < turn.m.size(); ++i) worst.near(again.m[i], turn.m[i]);
    }
  return worst.against("attitude: pitch of 90 degrees through the matrix", 1e-7);
}

StressCase depth_without_meaning() {
  Worst worst;
  constexpr hal::Instant kNow{std::chrono::seconds(1)};
  for (const int columns : {1, 2, 63, 64, 639, 640})
    for (const float depth :
         {0.0F, -0.0F, -1.0F, 0x1p-149F, std::numeric_limits<float>::quiet_NaN(),
          std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
      const hal::DepthCameraModel camera{columns, 7, 343.0, 442.0, columns / 2.0, 3.5, 0.15, 7.0};
      std::vector<float> image(static_cast<std::size_t>(columns * 7), depth);
      flight::ObstacleGuard guard({.nearest = 1});
      const auto verdict = [&] {
        return guard.check({kNow, camera, std::span<const float>(image)}, 0.5, 0.0, kNow);
      };
      worst.must(verdict().way == flight::WayAhead::blind);
      image[image.size() / 2] = 1.5F;  // one obstacle among what is unknown
      worst.must(verdict().way == flight::WayAhead::blocked);
      worst.near(verdict().range_m, 1.5);
    }
  return worst.against("obstacle guard: 0, NaN, infinities, negatives; odd widths", 0.0);
}

}  // namespace

std::vector<StressCase> stress_geometry() {
  return {tangent(),
          on_the_circle(),
          half_tracks_without_meaning(),
          slight_turns(),
          extreme_targets(),
          end_points(),
          wraps(),
          needle_sightings(),
          sightings_of_any_length(),
          looking_straight_up(),
          depth_without_meaning()};
}

}  // namespace forager::boards
