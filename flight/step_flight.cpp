#include "flight/step_flight.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr double kSlowTurnRadS = 0.35;  // slower than any vehicle turns; for time limits
constexpr double kSlowClimbMS = 0.2;
constexpr double kAtRestMS = 0.1;
constexpr double kSlowWay = 2.0;  // a way may take this many times its ideal time, and the slack

bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

}  // namespace

void StepFlight::enter(Stage stage, hal::Instant now, hal::Duration allowed) {
  stage_ = stage;
  entered_ = now;
  deadline_ = hal::Deadline(now, allowed);
}

void StepFlight::hold(const hal::Pose& pose_world) {
  stage_ = Stage::holding;
  goal_world_ = pose_world.position;
  yaw_rad_ = pose_world.yaw_rad;
  length_m_ = 0.0;
}

void StepFlight::begin(const Step& step, const hal::Pose& pose_world, double floor_z_m, hal::Instant now) {
  const double turn_rad = std::abs(hal::angle_difference(step.heading_rad, pose_world.yaw_rad));
  const double height_m = floor_z_m + step.height_m;
  const double climb_m = std::abs(height_m - goal_world_.z);
  goal_world_.z = height_m;
  start_world_ = goal_world_;
  began_world_ = pose_world.position;
  yaw_rad_ = step.heading_rad;
  length_m_ = step.length_m;
  speed_m_s_ = step.speed_m_s > 0.0 ? step.speed_m_s : config_.speed_m_s;
  run_m_ = 0.0;
  moved_m_ = 0.0;
  turned_ = turn_rad > config_.aligned_rad || climb_m > config_.arrival_m;
  last_update_ = now;
  enter(Stage::turning, now,
        config_.slack + hal::from_seconds(turn_rad / kSlowTurnRadS + climb_m / kSlowClimbMS));
}

PositionSetpoint StepFlight::setpoint(hal::Instant now) const {
  return {.position_world = goal_world_, .yaw_rad = yaw_rad_, .valid_until = now + config_.setpoint_validity};
}

double StepFlight::along(hal::Vec3 v) const { return v.x * std::cos(yaw_rad_) + v.y * std::sin(yaw_rad_); }

void StepFlight::hold_here(const hal::Pose& pose) {
  goal_world_.x = pose.position.x;
  goal_world_.y = pose.position.y;
}

StepOutcome StepFlight::finish(StepOutcome outcome) {
  stage_ = Stage::holding;
  length_m_ = 0.0;
  return outcome;
}

StepOutcome StepFlight::update(const hal::Pose& pose_world, hal::Vec3 velocity_world_m_s,
                               const GuardVerdict& way, hal::Instant now) {
  StepOutcome outcome = StepOutcome::arrived;
  switch (stage_) {
    case Stage::holding:
      break;
    case Stage::turning:
      outcome = turn(pose_world, now);
      break;
    case Stage::looking:
      outcome = look(way, now);
      break;
    case Stage::advancing:
      outcome = advance(pose_world, velocity_world_m_s, way, now);
      break;
    case Stage::stopping:
      outcome = stop(pose_world, velocity_world_m_s, now);
      break;
  }
  last_update_ = now;
  if (stage_ == Stage::holding) moved_m_ = hal::distance_xy(pose_world.position, began_world_);
  return outcome;
}

StepOutcome StepFlight::turn(const hal::Pose& pose, hal::Instant now) {
  const double off_rad = std::abs(hal::angle_difference(yaw_rad_, pose.yaw_rad));
  const bool level = near(pose.position.z, goal_world_.z, config_.arrival_m);
  const bool late = deadline_.expired(now);
  if (!level || off_rad > (late ? config_.arrival_yaw_rad : config_.aligned_rad))
    return late ? finish(StepOutcome::late) : StepOutcome::flying;
  if (length_m_ <= 0.0) return finish(StepOutcome::arrived);
  enter(Stage::looking, now, config_.look_timeout);
  return StepOutcome::flying;
}

// A frame from before the turn's end shows another direction, so it says nothing.
StepOutcome StepFlight::look(const GuardVerdict& way, hal::Instant now) {
  const bool current = way.stamp >= entered_;
  if (current && way.way == WayAhead::blocked) return finish(StepOutcome::blocked);
  if (current && way.way == WayAhead::clear) {
    enter(Stage::advancing, now, config_.slack + hal::from_seconds(kSlowWay * length_m_ / speed_m_s_));
    return StepOutcome::flying;
  }
  return deadline_.expired(now) ? finish(StepOutcome::blocked) : StepOutcome::flying;
}

StepOutcome StepFlight::advance(const hal::Pose& pose, hal::Vec3 velocity, const GuardVerdict& way,
                                hal::Instant now) {
  const double made_m = along(pose.position - start_world_);
  // Turned away from its way, it would fly where the camera does not look.
  const bool astray = std::abs(hal::angle_difference(yaw_rad_, pose.yaw_rad)) > config_.arrival_yaw_rad;
  if (way.way != WayAhead::clear || astray) {
    const double v = std::max(0.0, along(velocity));
    run_m_ = std::max(0.0, std::min(run_m_, made_m + v * v / (2.0 * config_.braking_m_s2)));
    goal_world_ = start_world_ + run_m_ * hal::Vec3{std::cos(yaw_rad_), std::sin(yaw_rad_), 0.0};
    enter(Stage::stopping, now, config_.slack);
    return StepOutcome::flying;
  }
  const double pace_m = run_m_ + speed_m_s_ * hal::to_seconds(now - last_update_);
  run_m_ = std::max(run_m_, std::min({length_m_, pace_m, made_m + config_.lead_m}));
  goal_world_ = start_world_ + run_m_ * hal::Vec3{std::cos(yaw_rad_), std::sin(yaw_rad_), 0.0};
  const bool there = run_m_ >= length_m_ && near(pose.position.x, goal_world_.x, config_.arrival_m) &&
                     near(pose.position.y, goal_world_.y, config_.arrival_m) &&
                     near(pose.position.z, goal_world_.z, config_.arrival_m);
  if (there) return finish(StepOutcome::arrived);
  if (!deadline_.expired(now)) return StepOutcome::flying;
  hold_here(pose);  // what is left of the way would be flown unseen
  return finish(StepOutcome::late);
}

StepOutcome StepFlight::stop(const hal::Pose& pose, hal::Vec3 velocity, hal::Instant now) {
  if (along(velocity) > kAtRestMS && !deadline_.expired(now)) return StepOutcome::flying;
  // It may have come to rest beyond the goal; going back to it would be flying backwards, unseen.
  if (along(pose.position - goal_world_) > 0.0) hold_here(pose);
  return finish(StepOutcome::blocked);
}

}  // namespace forager::flight
