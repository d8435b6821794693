#include "boards/drive_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/units.hpp"

namespace forager::boards {
namespace {

constexpr double kStanding = 0.01;  // m/s and rad/s
constexpr double kBound_s = 0.3;    // in which a vehicle outside its corridor must be safe

// From a body that is a square of twice half_width across to a box; negative inside.
double gap(const hal::Pose& pose, const DriveObstacle& box, double half_width) {
  const double dx = std::max({box.min_x - pose.position.x, pose.position.x - box.max_x, 0.0});
  const double dy = std::max({box.min_y - pose.position.y, pose.position.y - box.max_y, 0.0});
  return std::hypot(dx, dy) - half_width;
}

bool broken(DriveFault fault, bool left) {
  switch (fault) {
    case DriveFault::left_stuck_here:
    case DriveFault::left_open:
      return left;
    case DriveFault::right_stuck_here:
    case DriveFault::right_open:
      return !left;
    default:
      return false;
  }
}

}  // namespace

void DriveJudge::struck(DriveFault fault, double now_s) {
  result_->fault = fault;
  result_->struck_s = now_s;
}

void DriveJudge::detected(double now_s) {
  if (!result_->detected_s) result_->detected_s = now_s;
}

bool DriveJudge::grips(mocks::RollingVehicle& vehicle) const {
  const double enough = 0.5 * vehicle.parameters().brake_force_n;
  const bool left = broken(result_->fault, true) || vehicle.left_brake_n() >= enough;
  const bool right = broken(result_->fault, false) || vehicle.right_brake_n() >= enough;
  return left && right;
}

void DriveJudge::look(DriveRig& rig, double now_s) {
  mocks::RollingVehicle& vehicle = rig.vehicle();
  const mocks::BodyState& body = vehicle.state();
  if (!started_) last_ = body.pose;
  started_ = true;
  stands_ = norm(body.velocity_world_m_s) < kStanding && std::abs(body.yaw_rate_rad_s) < kStanding;
  const double nominal = vehicle.parameters().max_thrust_n * scene_->drive.steer.thrust *
                         std::sin(scene_->drive.steer.pitch_rad);
  const bool pushes = rig.push_demanded() || vehicle.drive_force_n() > 0.5 * nominal;
  look_around(vehicle, pushes, now_s);
  result_->thrust_n_s += vehicle.thrust_n() * 0.01;
  if (result_->detected_s) {
    result_->moved_after_m += norm(body.pose.position - last_.position);
    result_->turned_after_rad += std::abs(hal::angle_difference(body.pose.yaw_rad, last_.yaw_rad));
    if (!result_->safe_s && !pushes && (stands_ || grips(vehicle))) result_->safe_s = now_s;
  }
  last_ = body.pose;
}

void DriveJudge::look_around(const mocks::RollingVehicle& vehicle, bool pushes, double now_s) {
  const hal::Pose& pose = vehicle.state().pose;
  const double off = corridor_->distance_m(pose.position);
  result_->corridor_m = std::max(result_->corridor_m, off);
  for (const DriveObstacle& box : scene_->obstacles)
    result_->clearance_m = std::min(result_->clearance_m, gap(pose, box, scene_->body_half_width_m));
  if (off <= scene_->corridor_half_width_m) return;
  result_->left_corridor = true;
  if (!out_since_s_) out_since_s_ = now_s;
  if (pushes && now_s - *out_since_s_ > kBound_s) result_->out_without_stop = true;
}

void DriveJudge::close(DriveRig& rig, double now_s) {
  const hal::Pose& at = rig.vehicle().state().pose;
  const servo::PathPose& goal = scene_->path.back();
  result_->position_error_m = std::hypot(at.position.x - goal.x_m, at.position.y - goal.y_m);
  result_->heading_error_rad = std::abs(hal::angle_difference(at.yaw_rad, scene_->goal_heading_rad));
  result_->time_s = now_s;
  result_->stands = stands_;
  result_->energy_in_j = rig.vehicle().energy().put_in;
}

}  // namespace forager::boards
