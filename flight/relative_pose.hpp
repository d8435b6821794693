#pragma once

#include <cstdint>
#include <string_view>

namespace forager::flight {

// A point in a robot's map frame, metres.
struct MapPoint {
  double x_m = 0.0;
  double y_m = 0.0;
};

// What two robots that saw each other know, each in the frame of its own map (thesis sec. 5.5): the Detector
// where it is and where it found the Pawn, the Pawn where it is and where it found the Detector.
struct MutualSighting {
  MapPoint detector_itself;  // r'_D, in the Detector's frame
  MapPoint pawn_seen;        // r_P,  in the Detector's frame
  MapPoint pawn_itself;      // r'_P, in the Pawn's frame
  MapPoint detector_seen;    // r_D,  in the Pawn's frame
};

struct RelativePoseConfig {
  double distance_tolerance_m = 0.15;  // by which the two distances may differ
  double min_distance_m = 0.3;         // r_min: nearer than this a position error turns the angle too far
  double sigma_position_m = 0.05;      // of one sighting, 1 sigma
};

enum class PoseRejection : std::uint8_t {
  none,
  not_finite,        // a coordinate is NaN, infinite, or too large for its distance to be a double
  too_near,          // |p| < r_min: coincident robots have no bearing
  distances_differ,  // ||p| - |q|| above the tolerance: one of them saw something else
};
[[nodiscard]] std::string_view to_string(PoseRejection rejection);  // "distances differ", ...

// The Pawn's frame in the Detector's: a point s of the Pawn's map is R(phi) s + t in the Detector's.
struct RelativePose {
  PoseRejection rejection = PoseRejection::none;  // anything but none: the angle and translation mean nothing
  double phi_rad = 0.0;                           // (-pi, pi]
  MapPoint translation;                           // t = r_P - R(phi) r'_P
  double sigma_phi_rad = 0.0;                     // sqrt(2) sigma_position / |p|
  double distance_m = 0.0;                        // |p|, as the Detector has it
  double distance_difference_m = 0.0;             // |p| - |q|
};

// With p = r_P - r'_D in the Detector's frame and q = r_D - r'_P in the Pawn's,
// phi = atan2(p_x q_y - p_y q_x, -(p_x q_x + p_y q_y)). It replaces equations 5.17 and 5.18, which match an
// arccosine with an arcsine: beyond 90 degrees the two have no common value, for |p| != |q| neither may have
// one at all, and near 0, 180 and 90 degrees half of the digits are lost.
[[nodiscard]] RelativePose relative_pose(const MutualSighting& sighting, const RelativePoseConfig& config);

}  // namespace forager::flight
