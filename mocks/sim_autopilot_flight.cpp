#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/units.hpp"
#include "mocks/sim_autopilot.hpp"

namespace forager::mocks {
namespace {

using hal::Vec3;
using peer::CopterMode;

constexpr double kStopped = 0.05;    // m/s: what counts as standing still
constexpr double kReached = 0.1;     // m: what counts as having reached a height or home
constexpr double kDefaultTurn = 60;  // degrees/s of CONDITION_YAW without a rate (ATC_SLEW_YAW)

}  // namespace

VehicleCommand SimAutopilot::flight_command() {
  VehicleCommand command;
  command.motors = armed_ && vehicle_.battery_fraction() > 0.0;
  const bool takeoff = mode_ == CopterMode::guided && target_.kind == GuidedTarget::Kind::takeoff;
  if (!command.motors || (landed_ && !takeoff)) return command;
  switch (mode_) {
    case CopterMode::guided:
      fly_guided(command);
      break;
    case CopterMode::land:
      fly_land(command);
      break;
    case CopterMode::rtl:
      fly_rtl(command);
      break;
    // With no sticks moved the pilot is taken to hold the vehicle where it is.
    case CopterMode::stabilize:
    case CopterMode::alt_hold:
    case CopterMode::loiter:
    case CopterMode::brake:
      brake(command);
      break;
  }
  steer(command);
  return command;
}

// Heads for a place of the estimate's frame, given the way from where it believes to be.
void SimAutopilot::aim(VehicleCommand& command, Vec3 position_ned_m) const {
  const Vec3 way = estimator_.to_world(position_ned_m - estimator_.estimate().position_m);
  command.horizontal = command.vertical = VehicleCommand::Follow::position;
  command.position_world = state().pose.position + way;
  command.velocity_world_m_s = estimator_.to_world(-1.0 * estimator_.velocity_error_ned());
}

void SimAutopilot::brake(VehicleCommand& command) {
  if (!target_.stopped && norm(estimator_.estimate().velocity_m_s) < kStopped) {
    target_.position_ned_m = estimator_.estimate().position_m;
    target_.stopped = true;
  }
  if (target_.stopped) return aim(command, target_.position_ned_m);
  command.velocity_world_m_s = estimator_.to_world(-1.0 * estimator_.velocity_error_ned());
}

void SimAutopilot::fly_guided(VehicleCommand& command) {
  using Kind = GuidedTarget::Kind;
  const double step_s = hal::to_seconds(config_.step);
  if (target_.expires() && clock_ - target_.heard >= config_.guided_timeout) {
    const GuidedTarget old = target_;
    target_ = hold_here(estimator_.estimate(), clock_);
    if (old.yaw == GuidedTarget::Yaw::angle) target_.yaw_rad = old.yaw_rad;
  }
  switch (target_.kind) {
    case Kind::takeoff:
      fly_takeoff(command);
      break;
    case Kind::hold:
      brake(command);
      break;
    case Kind::position:
      aim(command, target_.position_ned_m);
      break;
    case Kind::position_velocity:
      target_.position_ned_m = target_.position_ned_m + step_s * target_.velocity_ned_m_s;
      aim(command, target_.position_ned_m);
      command.velocity_world_m_s = command.velocity_world_m_s + estimator_.to_world(target_.velocity_ned_m_s);
      break;
    case Kind::acceleration:
      target_.velocity_ned_m_s = target_.velocity_ned_m_s + step_s * target_.acceleration_ned_m_s2;
      [[fallthrough]];
    case Kind::velocity:
      if (target_.velocity_ned_m_s == Vec3{}) return brake(command);
      target_.stopped = false;
      command.velocity_world_m_s =
          estimator_.to_world(target_.velocity_ned_m_s - estimator_.velocity_error_ned());
      break;
  }
}

void SimAutopilot::fly_takeoff(VehicleCommand& command) {
  if (clock_ - armed_at_ < config_.spool_up) return;
  aim(command, target_.position_ned_m);
  if (std::abs(target_.position_ned_m.z - estimator_.estimate().position_m.z) > kReached) return;
  target_.kind = GuidedTarget::Kind::position;
  note("take-off complete");
}

void SimAutopilot::fly_land(VehicleCommand& command) {
  brake(command);
  command.vertical = VehicleCommand::Follow::velocity;
  const double height = home_ned_m_.z - estimator_.estimate().position_m.z;
  command.velocity_world_m_s.z =
      height > config_.land_fast_above_m ? -vehicle_.parameters().max_descent_m_s : -config_.land_speed_m_s;
}

void SimAutopilot::fly_rtl(VehicleCommand& command) {
  const Vec3 at = estimator_.estimate().position_m;
  const double top = std::min(home_ned_m_.z - config_.rtl_altitude_m, target_.position_ned_m.z);
  if (rtl_ == Rtl::climb) {
    aim(command, {target_.position_ned_m.x, target_.position_ned_m.y, top});
    if (at.z < top + kReached) rtl_ = Rtl::home;
  } else if (rtl_ == Rtl::home) {
    aim(command, {home_ned_m_.x, home_ned_m_.y, top});
    if (distance_xy(at, home_ned_m_) < kReached) {
      target_.position_ned_m = {home_ned_m_.x, home_ned_m_.y, at.z};
      target_.stopped = true;
      rtl_ = Rtl::land;
    }
  } else {
    fly_land(command);
  }
}

void SimAutopilot::steer(VehicleCommand& command) {
  const double step_s = hal::to_seconds(config_.step);
  if (turn_left_rad_ != 0.0) {
    const double rate = turn_rate_rad_s_ > 0.0 ? turn_rate_rad_s_ : hal::deg_to_rad(kDefaultTurn);
    const double part = std::clamp(turn_left_rad_, -rate * step_s, rate * step_s);
    target_.yaw_rad = hal::wrap_pi(target_.yaw_rad + part);
    turn_left_rad_ = std::abs(turn_left_rad_ - part) < 1e-12 ? 0.0 : turn_left_rad_ - part;
  }
  command.yaw_by_rate = target_.yaw == GuidedTarget::Yaw::rate;
  command.yaw_rate_rad_s = -target_.yaw_rate_rad_s;
  // Clockwise in its own estimate is clockwise of the body.
  const double way = hal::angle_difference(target_.yaw_rad, estimator_.estimate().yaw_rad);
  command.yaw_rad = hal::wrap_pi(state().pose.yaw_rad - way);
}

void SimAutopilot::watch_ground() {
  if (!state().on_ground) {
    touched_at_.reset();
    landed_ = false;
    return;
  }
  if (!touched_at_) touched_at_ = clock_;
  const bool takeoff = target_.kind == GuidedTarget::Kind::takeoff && mode_ == CopterMode::guided;
  if (!landed_ && clock_ - *touched_at_ >= config_.landed_after) {
    landed_ = true;
    idle_since_ = clock_;
    target_ = hold_here(estimator_.estimate(), clock_);
  }
  if (!armed_ || !landed_) return;
  const bool landing = mode_ == CopterMode::land || (mode_ == CopterMode::rtl && rtl_ == Rtl::land);
  if (landing ? clock_ - *touched_at_ >= config_.land_disarm
              : !takeoff && clock_ - idle_since_ >= config_.disarm_delay)
    disarm(true);
}

void SimAutopilot::watch_estimator() {
  if (estimator_.valid(clock_)) {
    failsafe_ = false;
    return;
  }
  if (failsafe_ || !in_flight()) return;
  failsafe_ = true;
  say_text(peer::kCritical, "EKF variance");
  if (mode_ == CopterMode::land || mode_ == CopterMode::stabilize || mode_ == CopterMode::alt_hold) return;
  mode_ = CopterMode::land;
  target_ = hold_here(estimator_.estimate(), clock_);
  say_text(peer::kCritical, "EKF Failsafe: changed to LAND Mode");
}

// EKF3 moved its position at once; everything it aims for moves along, so the vehicle does not.
void SimAutopilot::shift_targets(const EstimateShift& shift) {
  target_.position_ned_m = target_.position_ned_m + shift.ned_m;
  target_.yaw_rad = hal::wrap_pi(target_.yaw_rad + shift.yaw_rad);
  home_ned_m_ = home_ned_m_ + shift.ned_m;
}

bool SimAutopilot::set_mode(CopterMode mode, std::string_view reason) {
  if (mode == mode_) return true;
  const bool by_position = mode == CopterMode::guided || mode == CopterMode::loiter ||
                           mode == CopterMode::rtl || mode == CopterMode::brake;
  if (armed_ && by_position && !estimator_.valid(clock_)) {
    say_text(peer::kWarning, "Mode change failed: requires position");
    return false;
  }
  mode_ = mode;
  rtl_ = Rtl::climb;
  turn_left_rad_ = 0.0;
  target_ = hold_here(estimator_.estimate(), clock_);
  std::array<char, 64> line{};
  const auto end = fmt::format_to_n(line.data(), line.size(), "mode {}{}{}", static_cast<int>(mode),
                                    reason.empty() ? "" : " by ", reason);
  note({line.data(), std::min(end.size, line.size())});
  return true;
}

std::string_view SimAutopilot::arming_obstacle() const {
  if (!faults_.refuse_arming.empty()) return faults_.refuse_arming;
  if (mode_ == CopterMode::land || mode_ == CopterMode::rtl || mode_ == CopterMode::brake)
    return "Arm: Mode not armable";
  if (vehicle_.battery_fraction() < config_.arming_battery)
    return "PreArm: Battery 1 below minimum arming capacity";
  if (!origin_known_) return "PreArm: AHRS: waiting for home";
  if (!estimator_.healthy(clock_)) return "PreArm: VisOdom: not healthy";
  if (!estimator_.valid(clock_)) return "PreArm: Need Position Estimate";
  return {};
}

bool SimAutopilot::check_arming(bool report) {
  const std::string_view obstacle = arming_obstacle();
  if (!obstacle.empty() && report) say_text(peer::kCritical, obstacle);
  return obstacle.empty();
}

bool SimAutopilot::arm(bool force) {
  if (armed_) return true;
  if (!force && !check_arming(true)) return false;
  armed_ = true;
  armed_at_ = idle_since_ = clock_;
  home_ned_m_ = estimator_.estimate().position_m;
  target_ = hold_here(estimator_.estimate(), clock_);
  say_text(peer::kInfo, "Arming motors");
  return true;
}

bool SimAutopilot::disarm(bool force) {
  if (!armed_) return true;
  if (!force && !landed_) return false;
  armed_ = false;
  say_text(peer::kInfo, "Disarming motors");
  return true;
}

}  // namespace forager::mocks
