#include "flight/ground_detour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace forager::flight {
namespace {

constexpr double kCornerGap = 1e-6;  // corners stand this much outside, so that they touch nothing

struct Graph {
  std::vector<hal::Vec3> places;  // 0: from, 1: to, then corners
  std::span<const HopObstacle> obstacles;
  double half_width = 0.0;
};

// Into the frame of the obstacle.
hal::Vec3 local(hal::Vec3 world, const HopObstacle& o) {
  return hal::rotate_yaw(world - o.centre_world, -o.yaw_rad);
}

// Whether the way from a to b goes through the inside of the grown box (slab method).
bool crosses(hal::Vec3 a, hal::Vec3 b, const HopObstacle& o, double grow) {
  const hal::Vec3 p = local(a, o);
  const hal::Vec3 q = local(b, o);
  double enter = 0.0;
  double leave = 1.0;
  for (const auto& [at, to, half] :
       {std::array{p.x, q.x, o.half_x_m + grow}, std::array{p.y, q.y, o.half_y_m + grow}}) {
    const double way = to - at;
    if (way == 0.0) {
      if (std::abs(at) >= half) return false;
      continue;
    }
    const double first = (-half - at) / way;
    const double second = (half - at) / way;
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter < leave;
}

bool free_way(const Graph& graph, hal::Vec3 a, hal::Vec3 b) {
  return std::none_of(graph.obstacles.begin(), graph.obstacles.end(),
                      [&](const HopObstacle& o) { return crosses(a, b, o, graph.half_width); });
}

bool inside(hal::Vec3 p, const GroundArea& area) {
  return p.x >= area.min_x && p.x <= area.max_x && p.y >= area.min_y && p.y <= area.max_y;
}

void add_corners(Graph& graph, const HopObstacle& o, const GroundArea& area) {
  const double x = o.half_x_m + graph.half_width + kCornerGap;
  const double y = o.half_y_m + graph.half_width + kCornerGap;
  for (const hal::Vec3 corner : {hal::Vec3{x, y, 0.0}, {-x, y, 0.0}, {-x, -y, 0.0}, {x, -y, 0.0}}) {
    hal::Vec3 place = o.centre_world + hal::rotate_yaw(corner, o.yaw_rad);
    place.z = 0.0;
    if (inside(place, area)) graph.places.push_back(place);
  }
}

// Dijkstra without a heap: the graph is small and dense.
std::vector<std::size_t> shortest(const Graph& graph) {
  const std::size_t count = graph.places.size();
  std::vector<double> length(count, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(count, count);
  std::vector<bool> settled(count, false);
  length[0] = 0.0;
  for (;;) {
    std::size_t best = count;
    for (std::size_t i = 0; i < count; ++i)
      if (!settled[i] && std::isfinite(length[i]) && (best == count || length[i] < length[best])) best = i;
    if (best == count || best == 1) break;
    settled[best] = true;
    for (std::size_t i = 0; i < count; ++i) {
      const double through = length[best] + hal::distance_xy(graph.places[best], graph.places[i]);
      if (settled[i] || through >= length[i] || !free_way(graph, graph.places[best], graph.places[i]))
        continue;
      length[i] = through;
      before[i] = best;
    }
  }
  return before;
}

}  // namespace

std::optional<std::vector<hal::Vec3>> ground_detour(hal::Vec3 from_world, hal::Vec3 to_world,
                                                    std::span<const HopObstacle> obstacles,
                                                    double half_width_m, const GroundArea& area) {
  if (!hal::is_finite(from_world) || !hal::is_finite(to_world) || !inside(from_world, area) ||
      !inside(to_world, area))
    return std::nullopt;
  Graph graph{{from_world, to_world}, obstacles, half_width_m};
  graph.places[0].z = graph.places[1].z = 0.0;
  for (const HopObstacle& o : obstacles) add_corners(graph, o, area);
  const std::vector<std::size_t> before = shortest(graph);
  if (before[1] == graph.places.size()) return std::nullopt;
  std::vector<hal::Vec3> way;
  for (std::size_t at = 1;; at = before[at]) {
    way.push_back(graph.places[at]);
    if (at == 0) break;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace forager::flight
