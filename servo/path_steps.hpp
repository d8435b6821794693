#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/error.hpp"
#include "hal/units.hpp"

// From the poses of a path planner, one every 2.5 cm, to the few places a turn-then-drive vehicle stops at
// (thesis sec. 6.5.3).
namespace forager::servo {

// World frame, metres; yaw counter-clockwise from +x.
struct PathPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  bool operator==(const PathPose&) const = default;
};

struct StepConfig {
  double min_step_m = 0.425;  // nearer targets mean turns of most of a circle
  double max_step_m = 0.75;
  double tolerance_m = 0.05;  // how far a step may leave the path: 1 mm .. 10 m
  double goal_margin_m = 0.15;
  double heading_margin_rad = hal::deg_to_rad(10.0);
  bool operator==(const StepConfig&) const = default;
};

struct PathStep {
  double x_m = 0.0;
  double y_m = 0.0;
  std::size_t pose = 0;  // the path pose it stands on, or the one after it on a path with gaps
  bool close = false;    // nearer than min_step to the step before: the corner or the end did not allow more
  bool operator==(const PathStep&) const = default;
};

// The steps from the first pose (not a step: the vehicle stands there) to the last one, which is the last
// step. None if the whole path lies within goal_margin of its end.
//
// Bound: the line through the steps and the path are never farther apart than tolerance_m, walking both from
// start to end without turning back (Frechet distance), so no corner is cut by more and no reversal or loop
// is skipped. Steps are at most max_step_m apart. They are at least min_step_m apart wherever the bound
// leaves a choice: `close` steps are as few as they can be, then steps as few, then of even length. A curve
// of constant radius R can be steps of at least min_step_m if R >= min_step^2 / (8 tolerance), 0.45 m by
// default.
//
// The vehicle's centre follows the line through the steps up to its pivot: a turn Delta about a wheel at r
// takes it at most 2 r sin(min(Delta, pi)/2) off that line.
//
// Poses may be of any spacing, repeat, reverse and cross; gaps are filled with straight lines. Work grows
// with the path's length, about 6 us per pose. Errors: invalid_argument: no pose, one that is not finite, a
// path above 10 km, or config out of range.
[[nodiscard]] hal::Result<std::vector<PathStep>> path_steps(std::span<const PathPose> path,
                                                            const StepConfig& config);

// Within both margins of the goal.
[[nodiscard]] bool arrived(const PathPose& vehicle, const PathPose& goal, const StepConfig& config);

}  // namespace forager::servo
