#include "flight/relative_pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

MapPoint operator-(MapPoint a, MapPoint b) { return {a.x_m - b.x_m, a.y_m - b.y_m}; }
double length(MapPoint a) { return std::hypot(a.x_m, a.y_m); }

// a b + c d to 1.5 units in the last place (Kahan): the sums cancel exactly where the angle is near a
// multiple of 90 degrees.
double sum_of_products(double a, double b, double c, double d) {
  const double product = c * d;
  const double rest = std::fma(c, d, -product);
  return std::fma(a, b, product) + rest;
}

}  // namespace

std::string_view to_string(PoseRejection rejection) {
  switch (rejection) {
    case PoseRejection::none:
      return "none";
    case PoseRejection::not_finite:
      return "not finite";
    case PoseRejection::too_near:
      return "too near";
    case PoseRejection::distances_differ:
      return "distances differ";
  }
  return "?";
}

RelativePose relative_pose(const MutualSighting& sighting, const RelativePoseConfig& config) {
  RelativePose out;
  const MapPoint p = sighting.pawn_seen - sighting.detector_itself;
  const MapPoint q = sighting.detector_seen - sighting.pawn_itself;
  out.distance_m = length(p);
  out.distance_difference_m = out.distance_m - length(q);
  // Infinity minus infinity is NaN: one test for both lengths.
  if (!std::isfinite(out.distance_difference_m)) {
    out.rejection = PoseRejection::not_finite;
    return out;
  }
  if (!(out.distance_m >= config.min_distance_m && out.distance_m > 0.0)) {
    out.rejection = PoseRejection::too_near;
    return out;
  }
  if (!(std::abs(out.distance_difference_m) <= config.distance_tolerance_m)) {
    out.rejection = PoseRejection::distances_differ;
    return out;
  }
  if (q.x_m == 0.0 && q.y_m == 0.0) {  // under limits that allow anything
    out.rejection = PoseRejection::too_near;
    return out;
  }
  // The angle does not depend on lengths; dividing by their size keeps the products finite.
  const int scale_p = -std::ilogb(std::max(std::abs(p.x_m), std::abs(p.y_m)));
  const int scale_q = -std::ilogb(std::max(std::abs(q.x_m), std::abs(q.y_m)));
  const MapPoint a{std::ldexp(p.x_m, scale_p), std::ldexp(p.y_m, scale_p)};
  const MapPoint b{std::ldexp(q.x_m, scale_q), std::ldexp(q.y_m, scale_q)};
  const double sine = sum_of_products(a.x_m, b.y_m, -a.y_m, b.x_m);
  const double cosine = -sum_of_products(a.x_m, b.x_m, a.y_m, b.y_m);
  out.phi_rad = hal::wrap_pi(std::atan2(sine, cosine));

  const double c = std::cos(out.phi_rad);
  const double s = std::sin(out.phi_rad);
  const MapPoint itself = sighting.pawn_itself;
  out.translation = sighting.pawn_seen - MapPoint{sum_of_products(c, itself.x_m, -s, itself.y_m),
                                                  sum_of_products(s, itself.x_m, c, itself.y_m)};
  out.sigma_phi_rad = std::numbers::sqrt2 * config.sigma_position_m / out.distance_m;
  return out;
}

}  // namespace forager::flight
