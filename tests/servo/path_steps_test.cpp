#include "servo/path_steps.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "hal/random.hpp"

namespace forager::servo {
namespace {

using Path = std::vector<PathPose>;
using Steps = std::vector<PathStep>;

struct Place {
  double x, y;
};
double apart(Place a, Place b) { return std::hypot(a.x - b.x, a.y - b.y); }

// The straight lines through the corners as a planner gives them: a pose every spacing_m.
Path through(const std::vector<Place>& corners, double spacing_m = 0.025) {
  Path path{{corners[0].x, corners[0].y, 0.0}};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const auto [dx, dy] = Place{corners[i].x - corners[i - 1].x, corners[i].y - corners[i - 1].y};
    const int pieces = std::max(1, static_cast<int>(std::lround(std::hypot(dx, dy) / spacing_m)));
    for (int k = 1; k <= pieces; ++k)
      path.push_back(
          {corners[i - 1].x + dx * k / pieces, corners[i - 1].y + dy * k / pieces, std::atan2(dy, dx)});
  }
  return path;
}

Path arc(double radius_m, double angle_rad) {
  Path path;
  const int pieces = std::max(1, static_cast<int>(std::lround(radius_m * std::abs(angle_rad) / 0.025)));
  for (int k = 0; k <= pieces; ++k) {
    const double a = angle_rad * k / pieces;
    path.push_back({radius_m * std::sin(a), radius_m * (1.0 - std::cos(a)), a});
  }
  return path;
}

std::vector<Place> places(const Path& path) {
  std::vector<Place> out;
  for (const PathPose& pose : path) out.push_back({pose.x_m, pose.y_m});
  return out;
}
std::vector<Place> places(const Path& path, const Steps& steps) {
  std::vector<Place> out{{path[0].x_m, path[0].y_m}};
  for (const PathStep& step : steps) out.push_back({step.x_m, step.y_m});
  return out;
}

std::vector<Place> densified(const std::vector<Place>& line, double spacing_m) {
  std::vector<Place> out{line[0]};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double pieces = std::max(1.0, std::ceil(apart(line[i - 1], line[i]) / spacing_m));
    for (double k = 1.0; k <= pieces; ++k)
      out.push_back(
          {std::lerp(line[i - 1].x, line[i].x, k / pieces), std::lerp(line[i - 1].y, line[i].y, k / pieces)});
  }
  return out;
}

// Discrete Frechet distance (Eiter, Mannila 1994): at most half the spacing above the continuous one.
double frechet(const std::vector<Place>& a, const std::vector<Place>& b) {
  std::vector<double> row(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double diagonal = 0.0;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const double above = i > 0 ? row[j] : std::numeric_limits<double>::infinity();
      const double before = j > 0 ? row[j - 1] : std::numeric_limits<double>::infinity();
      const double corner = i > 0 && j > 0 ? diagonal : std::numeric_limits<double>::infinity();
      const double reach = i == 0 && j == 0 ? 0.0 : std::min({above, before, corner});
      diagonal = above;
      row[j] = std::max(reach, apart(a[i], b[j]));
    }
  }
  return row.back();
}

Steps stepped(const Path& path, const StepConfig& config = {}) {
  auto steps = path_steps(path, config);
  EXPECT_TRUE(steps.has_value());
  return steps.value_or(Steps{});
}

std::size_t close_ones(const Steps& steps) {
  return static_cast<std::size_t>(
      std::count_if(steps.begin(), steps.end(), [](const PathStep& s) { return s.close; }));
}

// What holds for every path: spacing, order, both ends, and the bound.
void check(const Path& path, const StepConfig& config, double sampling_m = 0.01) {
  const Steps steps = stepped(path, config);
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.back().x_m, path.back().x_m);
  EXPECT_EQ(steps.back().y_m, path.back().y_m);
  const auto line = places(path, steps);
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = apart(line[i - 1], line[i]);
    EXPECT_LE(length, config.max_step_m + 1e-8);
    EXPECT_EQ(steps[i - 1].close, length < config.min_step_m - 1e-9) << length;
    EXPECT_GE(steps[i - 1].pose, i > 1 ? steps[i - 2].pose : 0U);
  }
  EXPECT_LE(frechet(densified(places(path), sampling_m), densified(line, sampling_m)),
            config.tolerance_m + sampling_m / 2);
}

TEST(PathSteps, AStraightPathIsFewEvenSteps) {
  const Steps steps = stepped(through({{0, 0}, {3, 0}}));
  ASSERT_EQ(steps.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(steps[i].x_m, 0.75 * static_cast<double>(i + 1), 1e-12);
  const Steps uneven = stepped(through({{0, 0}, {1.6, 0}}));
  ASSERT_EQ(uneven.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_NEAR(uneven[i].x_m - uneven[i - 1].x_m, 1.6 / 3, 0.025);
}

// Any length from 0.85 m on is a sum of steps between 0.425 and 0.75 m: the remainder is never short, but for
// lengths that would need a place between two poses.
TEST(PathSteps, NoShortRemainderWhereTheLengthAllowsIt) {
  for (int cm = 20; cm < 400; ++cm) {
    const Steps steps = stepped(through({{0, 0}, {cm * 0.01, 0}}));
    const bool impossible = cm < 43 || (cm > 75 && cm < 85);
    const bool between_poses = cm >= 85 && cm < 90;
    EXPECT_LE(close_ones(steps), impossible || between_poses ? 1U : 0U) << cm;
    EXPECT_GE(close_ones(steps), impossible ? 1U : 0U) << cm;
  }
}

TEST(PathSteps, ACornerIsCutByNoMoreThanTheTolerance) {
  for (const double leg_m : {0.5, 0.9, 1.0, 1.13, 1.6}) {
    const Path path = through({{0, 0}, {leg_m, 0}, {leg_m, 2}});
    check(path, {});
    check(path, {.tolerance_m = 0.01});
  }
  EXPECT_EQ(close_ones(stepped(through({{0, 0}, {1.6, 0}, {1.6, 2}}))), 0U);
}

TEST(PathSteps, CurvesOfTheStatedRadiusNeedNoCloseStep) {
  check(arc(0.46, 3.0), {});
  EXPECT_EQ(close_ones(stepped(arc(0.6, 4.0))), 0U);
  EXPECT_EQ(close_ones(stepped(arc(2.0, -3.0))), 0U);
  EXPECT_GT(close_ones(stepped(arc(0.25, 3.0))), 0U);
}

TEST(PathSteps, AReversalIsNotSkipped) {
  const Path path = through({{0, 0}, {2, 0}, {1, 0}, {2.5, 0}});
  check(path, {});
  const Steps steps = stepped(path);
  EXPECT_NEAR(
      std::max_element(steps.begin(), steps.end() - 1, [](auto& a, auto& b) { return a.x_m < b.x_m; })->x_m,
      2.0, 0.55);
  EXPECT_GE(steps.size(), 5U);  // 4.5 m of way, though only 2.5 m from start to goal
}

TEST(PathSteps, AClosedLoopIsDrivenRound) {
  const Path loop = arc(1.0, 2 * hal::kPi);
  check(loop, {});
  EXPECT_GE(stepped(loop).size(), 9U);
  check(through({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}), {});
}

TEST(PathSteps, RepeatedPosesChangeNothing) {
  const Path path = through({{0, 0}, {1, 0.3}, {2, 0}});
  Path repeated;
  for (const PathPose& pose : path) repeated.insert(repeated.end(), 3, pose);
  const Steps once = stepped(path);
  const Steps thrice = stepped(repeated);
  ASSERT_EQ(once.size(), thrice.size());
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i].x_m, thrice[i].x_m);
}

TEST(PathSteps, PosesOfAnySpacing) {
  for (const double spacing_m : {1e-4, 0.003, 0.012, 0.3, 5.0})
    check(through({{0, 0}, {1.1, 0.4}, {1, 2}}, spacing_m), {});
}

TEST(PathSteps, AtTheGoalThereIsNothingToDo) {
  EXPECT_TRUE(stepped(through({{0, 0}, {0.1, 0}})).empty());
  EXPECT_TRUE(stepped({{1, 1, 0}}).empty());
  EXPECT_FALSE(stepped(through({{0, 0}, {1, 0}, {0.1, 0}})).empty());  // there and back is a way
}

TEST(PathSteps, ArrivalIsPlaceAndHeading) {
  const PathPose goal{1, 1, hal::kPi};
  EXPECT_TRUE(arrived({1.1, 1.1, -hal::kPi + 0.1}, goal, {}));
  EXPECT_FALSE(arrived({1.11, 1.11, hal::kPi}, goal, {}));
  EXPECT_FALSE(arrived({1, 1, hal::kPi - 0.18}, goal, {}));
  EXPECT_FALSE(arrived({1, 1, std::nan("")}, goal, {}));
}

TEST(PathSteps, RefusesWhatIsNoPath) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(path_steps(Path{}, {}));
  EXPECT_FALSE(path_steps(Path{{0, 0, 0}, {std::nan(""), 0, 0}}, {}));
  EXPECT_FALSE(path_steps(Path{{0, 0, 0}, {0, 0, inf}}, {}));
  EXPECT_FALSE(path_steps(Path{{0, 0, 0}, {1e7, 0, 0}}, {}));
  EXPECT_FALSE(path_steps(Path{{-1e308, 0, 0}, {1e308, 0, 0}}, {}));
  EXPECT_FALSE(path_steps(Path{{0, 0, 0}}, {.min_step_m = 0.8}));
  EXPECT_FALSE(path_steps(Path{{0, 0, 0}}, {.tolerance_m = 0.0}));
}

// Wandering paths with corners of every kind, any tolerance.
RC_GTEST_PROP(PathStepsProperty, TheBoundHoldsOnRandomPaths, (std::uint64_t seed)) {
  hal::Random random(seed);
  std::vector<Place> corners{{0, 0}};
  double heading = 0.0;
  for (double length = 0.0; length < 3.0;) {
    const double leg_m = random.chance(0.3) ? random.uniform(0.01, 0.2) : random.uniform(0.2, 1.0);
    heading += random.chance(0.1) ? hal::kPi : random.uniform(-1.5, 1.5);
    corners.push_back(
        {corners.back().x + leg_m * std::cos(heading), corners.back().y + leg_m * std::sin(heading)});
    length += leg_m;
  }
  check(through(corners), {.tolerance_m = random.uniform(0.005, 0.15), .goal_margin_m = 0.0});
}

}  // namespace
}  // namespace forager::servo
