// The ends of a drive: getting armed, the reasons to stop, and stopping.
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "flight/drive_loop.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "drive";
constexpr hal::Duration kAskAgain = std::chrono::milliseconds(500);

DriveEnd end_of(Interlock interlock) {
  switch (interlock) {
    case Interlock::emergency_stop:
      return DriveEnd::emergency_stop;
    case Interlock::deadman:
      return DriveEnd::deadman;
    case Interlock::autopilot_link:
      return DriveEnd::autopilot_lost;
    case Interlock::control:
      return DriveEnd::pilot;
    case Interlock::pose:
      return DriveEnd::pose_lost;
    case Interlock::brakes:
      return DriveEnd::brake_fault;
    case Interlock::corridor:
      return DriveEnd::left_corridor;
    case Interlock::motion:
      return DriveEnd::no_motion;
    case Interlock::command:
      return DriveEnd::halted;
    case Interlock::way_ahead:
      return DriveEnd::blocked;
  }
  return DriveEnd::halted;
}

}  // namespace

void DriveLoop::wait_for_links(hal::Instant now) {
  if (halt_asked_) return stop(DriveEnd::halted, "asked to stop before the start", now);
  if (autopilot_->state().link_up && autopilot_->state().armed)
    return stop(DriveEnd::pilot, "the vehicle is armed already: somebody else has it", now);
  const bool nothing = mission_.steps.empty();
  const auto usable = servo::BrakeSteer::usable(mission_.steps, mission_.goal_heading_rad);
  if (!nothing && !usable) return stop(DriveEnd::refused, usable.error().detail, now);
  if (interlocks_.may_arm() && autopilot_->state().pose_valid) {
    // A path within the goal's margin has no steps.
    if (nothing && at_goal()) return stop(DriveEnd::arrived, "at the goal already", now);
    if (nothing) return stop(DriveEnd::refused, usable.error().detail, now);
    enter(DrivePhase::guided, now);
    return autopilot_->request_guided(now);
  }
  if (!waited(config_.start_timeout, now)) return;
  for (const InterlockRule& rule : kInterlockTable)
    if (rule.to_arm && !interlocks_.holds(rule.interlock)) return stop(end_of(rule.interlock), rule.why, now);
  stop(DriveEnd::refused, "the autopilot does not know where it is", now);
}

bool DriveLoop::at_goal() const {
  const hal::Pose& at = status_.pose_world;
  const auto& heading = mission_.goal_heading_rad;
  return hal::distance_xy(at.position, mission_.corridor.path().back()) <= config_.steer.goal_margin_m &&
         (!heading ||
          std::abs(hal::angle_difference(*heading, at.yaw_rad)) <= config_.steer.heading_margin_rad);
}

bool DriveLoop::refused(std::string_view what, hal::Instant now) {
  if (halt_asked_) {
    stop(DriveEnd::halted, "asked to stop before the start", now);
  } else if (const InterlockRule* lost = interlocks_.first_latched(); lost != nullptr) {
    stop(end_of(lost->interlock), lost->why, now);
  } else if (autopilot_->request_state() == RequestState::refused) {
    stop(DriveEnd::refused, autopilot_->request_detail(), now);
  } else if (waited(config_.start_timeout, now)) {
    stop(DriveEnd::refused, what, now);
  } else {
    return false;
  }
  return true;
}

void DriveLoop::wait_for_mode(hal::Instant now) {
  if (refused("the autopilot did not go into GUIDED", now)) return;
  if (!autopilot_->state().guided || !interlocks_.may_arm()) return;
  enter(DrivePhase::arming, now);
  autopilot_->request_arm(now);
}

void DriveLoop::wait_for_arming(hal::Instant now) {
  if (refused("the autopilot did not arm", now) || !autopilot_->state().armed) return;
  if (const auto began = steer_.begin(mission_.steps, mission_.goal_heading_rad, now); !began)
    return stop(DriveEnd::refused, began.error().detail, now);
  status_.drove_from = now;
  enter(DrivePhase::driving, now);
}

void DriveLoop::drive(hal::Instant now) {
  if (halt_asked_) return stop(DriveEnd::halted, "asked to stop", now);
  if (const InterlockRule* lost = interlocks_.first_latched(); lost != nullptr)
    return stop(end_of(lost->interlock), lost->why, now);
  if (steer_.phase() == servo::SteerPhase::arrived) return stop(DriveEnd::arrived, "at the goal", now);
  if (steer_.phase() == servo::SteerPhase::failed) {
    const bool lost = steer_.fault() == servo::SteerFault::pose_lost;
    return stop(lost ? DriveEnd::pose_lost : DriveEnd::missed, to_string(steer_.fault()), now);
  }
  // As long as it may push, the controller is told so; without, it holds.
  if (interlocks_.may_thrust()) return steer_.renew(now + config_.command_life);
  if (!interlocks_.holds(Interlock::way_ahead) && now - interlocks_.lost_since() >= config_.blocked_for)
    stop(DriveEnd::blocked, "something in the way did not go away", now);
}

void DriveLoop::stop(DriveEnd why, std::string_view detail, hal::Instant now) {
  status_.end = why;
  status_.detail = detail;
  status_.stopped_from = now;
  steer_.stop();
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "end {}: {}", to_string(why), detail);
  journal_->note(now, kSource, {line.data(), line.size()});
  const bool never_armed = status_.phase == DrivePhase::waiting || status_.phase == DrivePhase::guided;
  if (why == DriveEnd::pilot) {
    // Armed on our request, if at all: an arming that nobody knows of is left to nobody.
    const bool ours = status_.phase == DrivePhase::arming && !autopilot_->state().in_air;
    hand_over();
    if (ours) autopilot_->request_disarm(now);
    return enter(ours || brakes_.stopping() ? DrivePhase::stopping : DrivePhase::done, now);
  }
  if (never_armed) return enter(DrivePhase::done, now);
  enter(DrivePhase::stopping, now);
  autopilot_->request_stop_motors(now);
  ask_again_at_ = now + kAskAgain;
}

// Nothing of ours is sent to a vehicle that somebody else has.
void DriveLoop::hand_over() {
  autopilot_->clear_setpoint();
  autopilot_->cancel_request();
}

// It stands on its wheels, both locked, so the motors may be stopped whatever the land detector says - unless
// a pilot took it, who may be flying by the time the request arrives. One brake needs to be told of the
// motion until it stands.
void DriveLoop::stopping(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  const bool theirs = autopilot.link_up && autopilot.armed && !autopilot.guided && !landing_asked_;
  if (theirs && status_.end != DriveEnd::pilot) {
    journal_->note(now, kSource, "end pilot: somebody took the vehicle while it stopped");
    status_.end = DriveEnd::pilot;
    status_.detail = "somebody took the vehicle while it stopped: " + status_.detail;
    hand_over();
  }
  const bool pending = autopilot_->request_state() == RequestState::pending;
  const bool disarmed = autopilot.link_up && !autopilot.armed;
  const bool settled = !pending && (disarmed || status_.end == DriveEnd::pilot);
  if ((settled || waited(config_.stopping_for, now)) && !brakes_.stopping())
    return enter(DrivePhase::done, now);
  if (settled || pending || now < ask_again_at_) return;
  ask_again_at_ = now + kAskAgain;
  autopilot_->request_stop_motors(now);
}

}  // namespace forager::flight
