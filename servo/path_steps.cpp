#include "servo/path_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace forager::servo {
namespace {

constexpr double kSpacingM =
    0.0125;  // steps may stand between poses: on 2.5 cm many curves end in a close step
constexpr double kThinningM = 0.01;  // poses nearer than this to the one before are left out
constexpr double kLongestM = 10e3;
constexpr double kRoundingM = 1e-9;  // 17 poses of 2.5 cm are 0.425 m, whatever their sum rounds to
constexpr std::size_t kReach = 256;  // points looked ahead; what lies beyond only costs a step more

struct Point {
  double x = 0.0;
  double y = 0.0;
  std::size_t pose = 0;
};

double distance(const Point& a, const Point& b) { return std::hypot(b.x - a.x, b.y - a.y); }

struct Line {
  std::vector<Point> points;
  double tolerance_m = 0.0;  // what thinning left of it
};

// The path at a spacing the search can afford, no farther from it than what the tolerance is reduced by.
Line even_line(std::span<const PathPose> path, double tolerance_m) {
  const double thinning_m = std::min(kThinningM, 0.2 * tolerance_m);
  Line line{{{path[0].x_m, path[0].y_m, 0}}, tolerance_m};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Point from = line.points.back();
    const Point to{path[i].x_m, path[i].y_m, i};
    const double gap_m = distance(from, to);
    if (gap_m == 0.0) {
      line.points.back().pose = i;
      continue;
    }
    if (gap_m < thinning_m && i + 1 < path.size()) {
      line.tolerance_m = tolerance_m - thinning_m;
      continue;
    }
    const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(gap_m / kSpacingM - 0.5)));
    for (std::size_t k = 1; k < pieces; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(pieces);
      line.points.push_back({from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part, i});
    }
    line.points.push_back(to);
  }
  return line;
}

// Whether the straight line from points[i] to points[j] stays with the points between, in their order: each
// needs a place on it within the tolerance, none before the place of an earlier one.
bool follows(std::span<const Point> points, std::size_t i, std::size_t j, double tolerance_m) {
  const Point& a = points[i];
  const double length = distance(a, points[j]);
  const double ux = length > 0.0 ? (points[j].x - a.x) / length : 0.0;
  const double uy = length > 0.0 ? (points[j].y - a.y) / length : 0.0;
  double place = 0.0;
  for (std::size_t k = i + 1; k < j; ++k) {
    const double dx = points[k].x - a.x;
    const double dy = points[k].y - a.y;
    const double along = dx * ux + dy * uy;
    const double across = length > 0.0 ? dx * uy - dy * ux : std::hypot(dx, dy);
    const double half = std::sqrt(std::max(tolerance_m * tolerance_m - across * across, 0.0));
    if (std::abs(across) > tolerance_m || along + half < place) return false;
    place = std::max(place, along - half);
    if (place > length) return false;
  }
  return true;
}

// In order of importance.
struct Cost {
  std::size_t close = 0;
  std::size_t steps = 0;
  double squares_m2 = 0.0;  // smallest when the lengths are even
  friend bool operator<(const Cost& a, const Cost& b) {
    return std::tie(a.close, a.steps, a.squares_m2) < std::tie(b.close, b.steps, b.squares_m2);
  }
};

struct Best {
  Cost cost{std::numeric_limits<std::size_t>::max(), 0, 0.0};
  std::size_t from = 0;
};

std::vector<Best> cheapest(const Line& line, const StepConfig& config) {
  const std::span<const Point> points = line.points;
  std::vector<Best> best(points.size());
  best[0].cost = {};
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const std::size_t last = std::min(points.size() - 1, i + kReach);
    for (std::size_t j = i + 1; j <= last; ++j) {
      const double length = distance(points[i], points[j]);
      // A line to anything behind this point would pass it by more than the tolerance.
      if (length > config.max_step_m + line.tolerance_m) break;
      if (length > config.max_step_m + kRoundingM) continue;
      Cost cost = best[i].cost;
      cost.close += length < config.min_step_m - kRoundingM ? 1U : 0U;
      ++cost.steps;
      cost.squares_m2 += length * length;
      if (cost < best[j].cost && follows(points, i, j, line.tolerance_m)) best[j] = {cost, i};
    }
  }
  return best;
}

std::string complaint(std::span<const PathPose> path, const StepConfig& config) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(config.max_step_m, 0.05, 100.0) || !within(config.min_step_m, 0.0, config.max_step_m))
    return fmt::format("steps of {} .. {} m: need 0 <= min <= max, max 0.05 .. 100", config.min_step_m,
                       config.max_step_m);
  if (!within(config.tolerance_m, 1e-3, 10.0))
    return fmt::format("tolerance {} m is not within 0.001 .. 10", config.tolerance_m);
  if (!within(config.goal_margin_m, 0.0, 100.0) || !within(config.heading_margin_rad, 0.0, hal::kPi))
    return "goal margin not within 0 .. 100 m or heading margin not within 0 .. pi";
  if (path.empty()) return "a path without poses";
  double length_m = 0.0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!std::isfinite(path[i].x_m) || !std::isfinite(path[i].y_m) || !std::isfinite(path[i].yaw_rad))
      return fmt::format("pose {} of {} is not finite", i, path.size());
    if (i > 0) length_m += std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
  }
  if (!(length_m <= kLongestM)) return fmt::format("a path of {} m is above {}", length_m, kLongestM);
  return {};
}

bool all_near_the_goal(std::span<const PathPose> path, double margin_m) {
  const PathPose& goal = path.back();
  return std::all_of(path.begin(), path.end(), [&](const PathPose& pose) {
    return std::hypot(pose.x_m - goal.x_m, pose.y_m - goal.y_m) <= margin_m;
  });
}

}  // namespace

hal::Result<std::vector<PathStep>> path_steps(std::span<const PathPose> path, const StepConfig& config) {
  if (std::string wrong = complaint(path, config); !wrong.empty())
    return hal::fail(hal::ErrorCode::invalid_argument, "path steps", "place steps", std::move(wrong));
  std::vector<PathStep> steps;
  if (all_near_the_goal(path, config.goal_margin_m)) return steps;
  const Line line = even_line(path, config.tolerance_m);
  const std::vector<Best> best = cheapest(line, config);
  for (std::size_t at = line.points.size() - 1; at != 0; at = best[at].from) {
    const Point& point = line.points[at];
    const bool close = distance(point, line.points[best[at].from]) < config.min_step_m - kRoundingM;
    steps.push_back({point.x, point.y, point.pose, close});
  }
  std::reverse(steps.begin(), steps.end());
  return steps;
}

bool arrived(const PathPose& vehicle, const PathPose& goal, const StepConfig& config) {
  return std::hypot(vehicle.x_m - goal.x_m, vehicle.y_m - goal.y_m) <= config.goal_margin_m &&
         std::abs(hal::angle_difference(vehicle.yaw_rad, goal.yaw_rad)) <= config.heading_margin_rad;
}

}  // namespace forager::servo
