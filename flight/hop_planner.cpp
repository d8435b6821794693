#include "flight/hop_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace forager::flight {
namespace {

// Along and beside the way.
struct Point {
  double along = 0.0;
  double beside = 0.0;
};

// A rectangle cut by two lines has eight corners at most.
struct Polygon {
  std::array<Point, 8> point{};
  std::size_t size = 0;
  void add(Point p) {
    if (size < point.size()) point[size++] = p;
  }
};

// Keeps where sign * beside <= limit (Sutherland and Hodgman 1974).
Polygon cut(const Polygon& polygon, double sign, double limit) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Point a = polygon.point[i];
    const Point b = polygon.point[(i + 1) % polygon.size];
    const double inside_a = limit - sign * a.beside;
    const double inside_b = limit - sign * b.beside;
    if (inside_a >= 0.0) kept.add(a);
    if ((inside_a >= 0.0) == (inside_b >= 0.0)) continue;
    const double share = inside_a / (inside_a - inside_b);
    kept.add({a.along + share * (b.along - a.along), a.beside + share * (b.beside - a.beside)});
  }
  return kept;
}

struct Blocked {
  WaySpan span;
  const HopObstacle* obstacle;
  std::size_t number;  // from 1, in the caller's order
};

bool finite(const HopObstacle& o) {
  return hal::is_finite(o.centre_world) && std::isfinite(o.half_x_m) && std::isfinite(o.half_y_m) &&
         o.half_x_m >= 0.0 && o.half_y_m >= 0.0 && std::isfinite(o.yaw_rad) &&
         (!o.height_m || std::isfinite(*o.height_m));
}

HopPlan refuse(HopReason reason, std::string detail) { return {reason, {}, std::move(detail)}; }

// One hop over obstacles [first, last) or why not.
class HopMaker {
 public:
  HopMaker(hal::Vec3 from, hal::Vec3 to, const HopLimits& limits)
      : from_(from), length_(hal::distance_xy(from, to)), limits_(limits) {
    ux_ = (to.x - from.x) / length_;
    uy_ = (to.y - from.y) / length_;
  }

  [[nodiscard]] double takeoff_at(const WaySpan& span) const {
    return span.begin_m - limits_.body_radius_m - limits_.takeoff_margin_m;
  }
  [[nodiscard]] double landing_at(double end_m) const {
    return end_m + limits_.body_radius_m + limits_.landing_margin_m;
  }

  // earliest: where the body already stands or has landed. `last` is moved past all obstacles it flies over.
  [[nodiscard]] HopPlan make(std::span<const Blocked> blocked, double earliest, std::size_t& used) const {
    const Blocked& first = blocked.front();
    const double wanted = takeoff_at(first.span);
    const double nearest = first.span.begin_m - limits_.body_radius_m - limits_.side_margin_m;
    const double takeoff = std::max(wanted, earliest);
    if (takeoff > std::max(wanted, nearest))
      return refuse(
          HopReason::too_near,
          fmt::format("obstacle {} begins {:.2f} m ahead; a take-off needs {:.2f} m", first.number,
                      first.span.begin_m - earliest, limits_.body_radius_m + limits_.side_margin_m));
    double end = first.span.end_m;
    double highest = 0.0;
    used = 0;
    for (const Blocked& next : blocked) {
      if (used > 0 && takeoff_at(next.span) >= landing_at(end)) break;
      if (!next.obstacle->height_m)
        return refuse(HopReason::height_unknown,
                      fmt::format("the height of obstacle {} is not known", next.number));
      end = std::max(end, next.span.end_m);
      highest = std::max(highest, *next.obstacle->height_m);
      ++used;
    }
    return finish(first.number, takeoff, landing_at(end), highest);
  }

  [[nodiscard]] double length() const { return length_; }

 private:
  [[nodiscard]] HopPlan finish(std::size_t number, double takeoff, double landing, double highest) const {
    const double climb = std::max(highest + limits_.height_margin_m, limits_.least_climb_m);
    if (climb > limits_.most_climb_m)
      return refuse(HopReason::too_high, fmt::format("obstacle {}: a climb of {:.2f} m, {:.2f} m are allowed",
                                                     number, climb, limits_.most_climb_m));
    if (climb + limits_.body_height_m + limits_.height_margin_m > limits_.ceiling_m)
      return refuse(HopReason::no_headroom,
                    fmt::format("obstacle {}: {:.2f} m are needed under a ceiling at {:.2f} m", number,
                                climb + limits_.body_height_m + limits_.height_margin_m, limits_.ceiling_m));
    if (landing > length_)
      return refuse(HopReason::no_landing,
                    fmt::format("obstacle {}: the way ends {:.2f} m before a place to land", number,
                                landing - length_));
    if (landing - takeoff > limits_.most_length_m)
      return refuse(HopReason::too_long, fmt::format("obstacle {}: a hop of {:.2f} m, {:.2f} m are allowed",
                                                     number, landing - takeoff, limits_.most_length_m));
    Hop hop;
    hop.takeoff_world = at(takeoff);
    hop.landing_world = at(landing);
    hop.yaw_rad = std::atan2(uy_, ux_);
    hop.climb_m = climb;
    hop.length_m = landing - takeoff;
    hop.highest_m = highest;
    return {HopReason::hop, {hop}, {}};
  }
  [[nodiscard]] hal::Vec3 at(double along) const {
    return {from_.x + along * ux_, from_.y + along * uy_, 0.0};
  }

  hal::Vec3 from_;
  double length_;
  const HopLimits& limits_;
  double ux_ = 1.0;
  double uy_ = 0.0;
};

}  // namespace

std::string_view to_string(HopReason reason) {
  constexpr std::array<std::string_view, 9> kNames{"free",       "hop",         "height_unknown",
                                                   "too_high",   "no_headroom", "too_near",
                                                   "no_landing", "too_long",    "invalid"};
  return kNames[static_cast<std::size_t>(reason)];
}

std::optional<WaySpan> span_on_way(hal::Vec3 from_world, hal::Vec3 to_world, const HopObstacle& obstacle,
                                   double half_width_m) {
  const double length = hal::distance_xy(from_world, to_world);
  const double ux = (to_world.x - from_world.x) / length;
  const double uy = (to_world.y - from_world.y) / length;
  Polygon polygon;
  for (const auto& [sx, sy] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
    const hal::Vec3 corner =
        obstacle.centre_world +
        hal::rotate_yaw({sx * obstacle.half_x_m, sy * obstacle.half_y_m, 0.0}, obstacle.yaw_rad);
    const double dx = corner.x - from_world.x;
    const double dy = corner.y - from_world.y;
    polygon.add({ux * dx + uy * dy, ux * dy - uy * dx});
  }
  polygon = cut(cut(polygon, 1.0, half_width_m), -1.0, half_width_m);
  if (polygon.size == 0) return std::nullopt;
  WaySpan span{polygon.point[0].along, polygon.point[0].along};
  for (std::size_t i = 1; i < polygon.size; ++i) {
    span.begin_m = std::min(span.begin_m, polygon.point[i].along);
    span.end_m = std::max(span.end_m, polygon.point[i].along);
  }
  return span;
}

HopPlan plan_hops(hal::Vec3 from_world, hal::Vec3 to_world, std::span<const HopObstacle> obstacles,
                  const HopLimits& limits) {
  const double length = hal::distance_xy(from_world, to_world);
  if (!hal::is_finite(from_world) || !hal::is_finite(to_world) || !(length > 0.0))
    return refuse(HopReason::invalid, "the way has no two different, finite ends");
  const double half_width = limits.body_radius_m + limits.side_margin_m;
  std::vector<Blocked> blocked;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!finite(obstacles[i]))
      return refuse(HopReason::invalid, fmt::format("obstacle {} is not finite", i + 1));
    const auto span = span_on_way(from_world, to_world, obstacles[i], half_width);
    // What ends behind the start is behind; what begins where the body does not reach is beyond the goal.
    if (span && span->end_m > 0.0 && span->begin_m < length + half_width)
      blocked.push_back({*span, &obstacles[i], i + 1});
  }
  if (blocked.empty()) return {HopReason::free, {}, {}};
  std::sort(blocked.begin(), blocked.end(),
            [](const Blocked& a, const Blocked& b) { return a.span.begin_m < b.span.begin_m; });

  const HopMaker maker(from_world, to_world, limits);
  HopPlan plan{HopReason::hop, {}, {}};
  double earliest = 0.0;
  for (std::span<const Blocked> left = blocked; !left.empty();) {
    std::size_t used = 0;
    HopPlan one = maker.make(left, earliest, used);
    if (one.reason != HopReason::hop) return one;
    earliest = hal::distance_xy(from_world, one.hops.front().landing_world);
    plan.hops.push_back(one.hops.front());
    left = left.subspan(used);
  }
  return plan;
}

}  // namespace forager::flight
