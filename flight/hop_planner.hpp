#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/pose.hpp"

// Hops of the hybrid vehicle over low obstacles whose height is known (thesis sec. 6.9, future work 2): where
// to take off, how high, where to land. World frame, metres, z from the floor up.
namespace forager::flight {

// A box that stands on the floor.
struct HopObstacle {
  hal::Vec3 centre_world;  // z is not used
  double half_x_m = 0.0;
  double half_y_m = 0.0;
  double yaw_rad = 0.0;
  std::optional<double> height_m;  // unknown: nobody hops over it
};

struct HopLimits {
  double body_radius_m = 0.65;     // wheels and propellers
  double side_margin_m = 0.20;     // between body and obstacles beside the way, rolling and flying
  double takeoff_margin_m = 0.30;  // between body and obstacle where it climbs; straight up is never exact
  double landing_margin_m = 0.40;  // and where it comes down, with the drift of a flight
  double height_margin_m = 0.40;   // between the obstacle's top and the wheels
  double least_climb_m = 0.50;     // lower is no take-off
  double most_climb_m = 1.60;      // what is higher is not a low obstacle
  double most_length_m = 6.0;      // from take-off to landing
  double body_height_m = 0.40;     // above the wheels, for the ceiling
  double ceiling_m = std::numeric_limits<double>::infinity();
};

enum class HopReason : std::uint8_t {
  free,            // nothing in the way: no hop needed
  hop,             // can be hopped
  height_unknown,  // an obstacle in the way has no known height
  too_high,        // higher than a hop may climb
  no_headroom,     // the ceiling is too low above it
  too_near,        // no room to take off before it
  no_landing,      // the way ends before a place to land is reached
  too_long,        // from take-off to landing
  invalid,         // a place or an obstacle that is not finite, or no way at all
};
[[nodiscard]] std::string_view to_string(HopReason reason);

struct Hop {
  hal::Vec3 takeoff_world;  // z: 0
  hal::Vec3 landing_world;
  double yaw_rad = 0.0;  // from take-off to landing
  double climb_m = 0.0;  // height of the wheels while it flies over
  double length_m = 0.0;
  double highest_m = 0.0;  // of the obstacles under it
};

struct HopPlan {
  HopReason reason = HopReason::invalid;
  std::vector<Hop> hops;  // in the order of the way; only if reason is hop
  std::string detail;     // for people: which obstacle, which number
  [[nodiscard]] bool passable() const { return reason == HopReason::free || reason == HopReason::hop; }
};

// Along the straight way from one place to another: which obstacles stand in the strip that the body sweeps,
// and a hop over each group of them that leaves no room to land between. Exact for boxes: each is clipped
// against the strip. Total: every input gives a plan or a reason.
[[nodiscard]] HopPlan plan_hops(hal::Vec3 from_world, hal::Vec3 to_world,
                                std::span<const HopObstacle> obstacles, const HopLimits& limits);

// The part of the way [begin, end], in metres from `from`, where the obstacle reaches into the strip of this
// half width; nothing if it does not. It may begin before 0 or end behind the way.
struct WaySpan {
  double begin_m = 0.0;
  double end_m = 0.0;
};
[[nodiscard]] std::optional<WaySpan> span_on_way(hal::Vec3 from_world, hal::Vec3 to_world,
                                                 const HopObstacle& obstacle, double half_width_m);

}  // namespace forager::flight
