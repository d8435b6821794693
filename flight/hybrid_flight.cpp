// The part of the hybrid mode between the wheels leaving the ground and standing on it again.
#include <fmt/format.h>

#include <cmath>

#include "flight/hybrid_mode.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr hal::Duration kAskAgain = std::chrono::seconds(2);

}  // namespace

bool HybridMode::refused(std::string_view what, hal::Instant now) {
  if (halt_asked_)
    stop(HybridEnd::halted, "asked to stop", now);
  else if (!autopilot_->state().link_up)
    give_up_command(HybridEnd::autopilot_lost, "no heartbeat from the autopilot", now);
  else if (autopilot_->request_state() == RequestState::refused)
    stop(HybridEnd::refused, autopilot_->request_detail(), now);
  else if (waited(config_.ask_timeout, now))
    stop(HybridEnd::refused, what, now);
  else
    return false;
  return true;
}

void HybridMode::wait_for_mode(hal::Instant now) {
  if (refused("the autopilot did not go into GUIDED", now) || !autopilot_->state().guided) return;
  enter(HybridPhase::arming, now);
  autopilot_->request_arm(now);
}

void HybridMode::wait_for_arming(hal::Instant now) {
  if (!halt_asked_ && autopilot_->state().link_up && !autopilot_->state().guided) return give_up_arming(now);
  if (refused("the autopilot did not arm", now) || !autopilot_->state().armed) return;
  enter(HybridPhase::climbing, now);
  autopilot_->request_takeoff(hop().climb_m, now);
}

// A pilot took it while it was being armed. It stands on the ground, perhaps with its motors running by now:
// disarmed once, which an autopilot that flies refuses.
void HybridMode::give_up_arming(hal::Instant now) {
  set_end(HybridEnd::pilot, "somebody took it while it was being armed", now);
  autopilot_->clear_setpoint();
  autopilot_->cancel_request();
  if (autopilot_->state().in_air) return enter(HybridPhase::done, now);
  autopilot_->request_disarm(now);
  enter(HybridPhase::stopped, now);
}

// In climbing and flying, what ends the flight early; false: go on.
bool HybridMode::gone_wrong_in_the_air(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  const auto bad = localisation_.bad_since();
  if (!autopilot.link_up)
    give_up_command(HybridEnd::autopilot_lost, "no heartbeat from the autopilot", now);
  else if (halt_asked_)  // before GUIDED is asked for: halt() made it leave that
    stop(HybridEnd::halted, "asked to stop", now);
  else if (!autopilot.guided || !autopilot.armed)
    give_up_command(HybridEnd::pilot, autopilot.armed ? "the autopilot left GUIDED" : "it disarmed", now);
  else if (bad && now - *bad >= config_.pose_allowance)
    stop(HybridEnd::pose_lost, "no trustworthy pose in the air", now);
  else
    return false;
  return true;
}

void HybridMode::climb(hal::Instant now) {
  if (gone_wrong_in_the_air(now)) return;
  if (autopilot_->request_state() == RequestState::refused)
    return stop(HybridEnd::refused, autopilot_->request_detail(), now);
  if (waited(config_.climb_timeout, now)) return stop(HybridEnd::late, "it did not get to the height", now);
  if (status_.pose_world.position.z < floor_z_m_ + hop().climb_m - config_.climb_slack_m) return;
  flight_.hold(status_.pose_world);
  aim(now);
  enter(HybridPhase::flying, now);
}

// Turn to the landing and go there, at the height of the hop.
void HybridMode::aim(hal::Instant now) {
  const hal::Vec3 way = hop().landing_world - status_.pose_world.position;
  Step step = step_along(std::atan2(way.y, way.x), std::hypot(way.x, way.y), status_.pose_world);
  step.height_m = hop().climb_m;
  flight_.begin(step, status_.pose_world, floor_z_m_, now);
}

void HybridMode::fly(hal::Instant now) {
  if (gone_wrong_in_the_air(now)) return;
  // The way was planned over what is known; nothing is looked at from up here.
  GuardVerdict planned;
  planned.way = WayAhead::clear;
  planned.stamp = now;
  const StepOutcome outcome =
      flight_.update(status_.pose_world, autopilot_->state().velocity_world_m_s, planned, now);
  autopilot_->set_position(flight_.setpoint(now));
  if (outcome == StepOutcome::flying) return;
  const double off_m = hal::distance_xy(status_.pose_world.position, hop().landing_world);
  if (outcome == StepOutcome::late)
    return stop(HybridEnd::late, fmt::format("{:.2f} m from the landing", off_m), now);
  const bool still = still_since_ && now - *still_since_ >= config_.stand_for;
  if (!still && !waited(config_.landing_timeout, now)) return;
  if (off_m > config_.landing_off_m) {
    aim(now);
    still_since_.reset();
    return;
  }
  autopilot_->clear_setpoint();
  autopilot_->request_land(now);
  ask_again_at_ = now + kAskAgain;
  landing_mode_.reset();
  enter(HybridPhase::landing, now);
}

bool HybridMode::taken_while_landing() {
  const AutopilotState& autopilot = autopilot_->state();
  if (autopilot.guided) return false;
  if (!landing_mode_) landing_mode_ = autopilot.custom_mode;
  return *landing_mode_ != autopilot.custom_mode;
}

void HybridMode::ask_down(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  if (now < ask_again_at_ || autopilot_->request_state() == RequestState::pending) return;
  ask_again_at_ = now + kAskAgain;
  if (!autopilot.in_air)
    autopilot_->request_disarm(now);
  else if (autopilot.guided)
    autopilot_->request_land(now);
}

void HybridMode::land(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  if (halt_asked_) return stop(HybridEnd::halted, "asked to stop", now);
  if (!autopilot.link_up) return give_up_command(HybridEnd::autopilot_lost, "silent while it landed", now);
  if (taken_while_landing()) return give_up_command(HybridEnd::pilot, "another mode while it landed", now);
  if (waited(config_.landing_timeout, now)) return stop(HybridEnd::late, "the landing took too long", now);
  const bool asked = autopilot_->request_state() == RequestState::pending;
  if (autopilot.armed || autopilot.in_air || asked) return ask_down(now);
  ++status_.hops;
  leg_over(now);
}

// Something went wrong: down, if it is up, and an end.
void HybridMode::stop(HybridEnd why, std::string_view detail, hal::Instant now) {
  set_end(why, detail, now);
  const AutopilotState& autopilot = autopilot_->state();
  const bool may_arm = status_.phase == HybridPhase::arming || status_.phase == HybridPhase::climbing;
  const bool rolled = status_.phase == HybridPhase::rolling;  // the driver has disarmed, or does
  if (rolled || (!autopilot.armed && !may_arm)) return enter(HybridPhase::done, now);
  autopilot_->clear_setpoint();
  // One that has left GUIDED lands already, or is somebody else's.
  const bool lands = status_.phase == HybridPhase::landing;
  if (autopilot.in_air && (autopilot.guided || lands))
    autopilot_->request_land(now);
  else if (!autopilot.in_air)
    autopilot_->request_disarm(now);
  ask_again_at_ = now + kAskAgain;
  landing_mode_.reset();
  enter(HybridPhase::stopped, now);
}

void HybridMode::come_down(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  const bool asked = autopilot_->request_state() == RequestState::pending;
  const bool down = !autopilot.armed && !autopilot.in_air && !asked;
  if (status_.end == HybridEnd::pilot) {  // asked once, above
    if (autopilot.in_air) autopilot_->cancel_request();
    if (!asked || autopilot.in_air || !autopilot.link_up) enter(HybridPhase::done, now);
    return;
  }
  if (!autopilot.link_up || down || taken_while_landing() || waited(config_.landing_timeout, now))
    return enter(HybridPhase::done, now);
  ask_down(now);
}

void HybridMode::give_up_command(HybridEnd why, std::string_view detail, hal::Instant now) {
  set_end(why, detail, now);
  autopilot_->clear_setpoint();
  enter(HybridPhase::done, now);
}

}  // namespace forager::flight
