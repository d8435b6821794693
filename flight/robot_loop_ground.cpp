// The ends of a mission: getting into the air, the limits, and coming down again.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "flight/robot_loop.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "mission";
constexpr hal::Duration kAskAgain = std::chrono::seconds(2);
constexpr hal::Duration kOnTheGround = std::chrono::milliseconds(500);

}  // namespace

void RobotLoop::enter(MissionPhase phase, hal::Instant now) {
  const bool flying_on =
      (phase == MissionPhase::listening || phase == MissionPhase::stepping) &&
      (status_.phase == MissionPhase::listening || status_.phase == MissionPhase::stepping);
  status_.phase = phase;
  status_.phase_since = now;
  if (flying_on) return;  // the windows tell that story
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "phase {}", to_string(phase));
  journal_->note(now, kSource, {line.data(), line.size()});
}

bool RobotLoop::waited(hal::Duration allowed, hal::Instant now) const {
  return now - status_.phase_since >= allowed;
}

void RobotLoop::set_end(EndReason why, std::string_view detail, hal::Instant now) {
  if (status_.end != EndReason::none) return;
  status_.end = why;
  status_.detail = detail;
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "end {}: {}", to_string(why), detail);
  journal_->note(now, kSource, {line.data(), line.size()});
}

void RobotLoop::wait_for_links(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  if (halt_asked_) return end_on_ground(EndReason::halted, "asked to stop before the start", now);
  if (autopilot.link_up && (autopilot.armed || autopilot.in_air)) {
    // Not ours to land or disarm either: whoever armed it has it.
    set_end(EndReason::refused, "the vehicle is armed already: somebody else has it", now);
    return hands_off(now);
  }
  EndReason missing = EndReason::none;
  std::string_view what;
  if (!autopilot.link_up) {
    missing = EndReason::autopilot_lost;
    what = "no heartbeat from the autopilot";
  } else if (!reader_->link().reading()) {
    missing = EndReason::reader_lost;
    what = reader_->link().phase == reader::LinkPhase::open ? "the reader's event stream says nothing"
           : reader_->link().reason.empty()                 ? std::string_view("the reader is not reading")
                                                            : std::string_view(reader_->link().reason);
  } else if (!localisation_.healthy()) {
    missing = EndReason::pose_lost;
    what = "no trustworthy pose";
  } else if (!autopilot.pose_valid) {
    missing = EndReason::pose_lost;
    what = "the autopilot does not know where it is";
  }
  if (missing == EndReason::none) {
    status_.detail.clear();
    enter(MissionPhase::guided, now);
    autopilot_->request_guided(now);
    return;
  }
  if (status_.detail != what) status_.detail = what;
  const bool hopeless = reader_->link().phase == reader::LinkPhase::failed;
  if (hopeless || waited(config_.limits.start_timeout, now))
    end_on_ground(hopeless ? EndReason::reader_lost : missing,
                  hopeless ? std::string_view(reader_->link().reason) : what, now);
}

bool RobotLoop::refused_on_ground(std::string_view what, hal::Instant now) {
  if (halt_asked_)
    end_on_ground(EndReason::halted, "asked to stop before take-off", now);
  else if (!autopilot_->state().link_up)
    end_on_ground(EndReason::autopilot_lost, "no heartbeat from the autopilot", now);
  else if (autopilot_->request_state() == RequestState::refused)
    end_on_ground(EndReason::refused, autopilot_->request_detail(), now);
  else if (waited(config_.limits.start_timeout, now))
    end_on_ground(EndReason::refused, what, now);
  else
    return false;
  return true;
}

void RobotLoop::wait_for_mode(hal::Instant now) {
  if (refused_on_ground("the autopilot did not go into GUIDED", now) || !autopilot_->state().guided) return;
  enter(MissionPhase::arming, now);
  autopilot_->request_arm(now);
}

void RobotLoop::wait_for_arming(hal::Instant now) {
  if (refused_on_ground("the autopilot did not arm", now) || !autopilot_->state().armed) return;
  if (!autopilot_->state().battery_fraction)
    journal_->note(now, kSource, "the autopilot tells nothing of its battery: its reserve is not watched");
  floor_z_m_ = pose_world_.position.z;
  status_.took_off = now;
  enter(MissionPhase::takeoff, now);
  autopilot_->request_takeoff(config_.takeoff_height_m, now);
}

// True: go on with the phase.
bool RobotLoop::obey_limits(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  Vitals vitals;
  vitals.now = now;
  vitals.airborne_since = status_.took_off;
  vitals.halt_asked = halt_asked_;
  vitals.autopilot_link_up = autopilot.link_up;
  vitals.guided = autopilot.guided;
  vitals.armed = autopilot.armed;
  vitals.reader_failed = reader_->link().phase == reader::LinkPhase::failed;
  vitals.reader_lost_since = reader_lost_since_;
  vitals.pose_bad_since = localisation_.bad_since();
  vitals.store_failing_since = sink_.failing_since();
  vitals.battery_fraction = autopilot.battery_fraction;
  const Verdict verdict = judge(config_.limits, vitals);
  switch (verdict.consequence) {
    case Consequence::go_on:
      return true;
    case Consequence::fall_silent:
      set_end(verdict.reason, verdict.detail, now);
      autopilot_->clear_setpoint();
      enter(MissionPhase::silent, now);
      break;
    case Consequence::hands_off:
      set_end(verdict.reason, verdict.detail, now);
      hands_off(now);
      break;
    case Consequence::land:
      start_landing(verdict.reason, verdict.detail, now);
      break;
  }
  return false;
}

void RobotLoop::stay_silent(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  if (!autopilot.link_up) {
    if (waited(config_.limits.autopilot_allowance, now)) hands_off(now);
    return;
  }
  // Back again. In GUIDED it still waits for us; in any other mode its own failsafe or a pilot has it.
  if (autopilot.armed && autopilot.guided)
    start_landing(EndReason::autopilot_lost, "the autopilot came back", now);
  else
    hands_off(now);
}

void RobotLoop::end_on_ground(EndReason why, std::string_view detail, hal::Instant now) {
  set_end(why, detail, now);
  // Told to arm, it may be armed before its next heartbeat says so, or when a lost answer is repeated.
  const bool may_arm = status_.phase == MissionPhase::arming && autopilot_->state().link_up &&
                       autopilot_->request_state() != RequestState::refused;
  if (!autopilot_->state().armed && !may_arm) return finish(now);
  enter(MissionPhase::landing, now);
  autopilot_->request_disarm(now);
  ask_again_at_ = now + kAskAgain;
}

void RobotLoop::start_landing(EndReason why, std::string_view detail, hal::Instant now) {
  set_end(why, detail, now);
  flight_.hold(pose_world_);
  autopilot_->clear_setpoint();
  autopilot_->request_land(now);
  ask_again_at_ = now + kAskAgain;
  landing_mode_.reset();
  enter(MissionPhase::landing, now);
}

void RobotLoop::land(hal::Instant now) {
  const AutopilotState& autopilot = autopilot_->state();
  const bool asked = autopilot_->request_state() == RequestState::pending;
  if ((autopilot.link_up && !autopilot.armed && !asked) || waited(config_.limits.landing_timeout, now))
    return finish(now);
  if (!autopilot.link_up) return;
  if (!autopilot.in_air && !status_.touched_down && waited(kOnTheGround, now)) status_.touched_down = now;
  if (!autopilot.guided) {
    if (!landing_mode_) landing_mode_ = autopilot.custom_mode;
    if (*landing_mode_ != autopilot.custom_mode) return hands_off(now);  // a pilot took over
  }
  if (now < ask_again_at_) return;
  ask_again_at_ = now + kAskAgain;
  if (!autopilot.in_air) {
    autopilot_->request_disarm(now);
  } else if (autopilot.guided && autopilot_->request_state() != RequestState::pending) {
    autopilot_->request_land(now);
  }
}

void RobotLoop::hands_off(hal::Instant now) {
  autopilot_->clear_setpoint();
  finish(now);
}

// Before `guided` the vehicle is not ours yet, from `silent` on not any more.
void RobotLoop::abandon() noexcept {
  if (done()) return;
  const bool ours = status_.phase != MissionPhase::waiting && status_.phase != MissionPhase::silent &&
                    status_.phase != MissionPhase::storing;
  if (ours) autopilot_->halt();
  reader_->halt();
  if (status_.end == EndReason::none) status_.end = EndReason::halted;
  status_.phase = MissionPhase::done;
}

void RobotLoop::finish(hal::Instant now) {
  if (status_.took_off && !status_.touched_down) status_.touched_down = now;
  intake_.drop_window();
  reader_->halt();
  enter(MissionPhase::storing, now);
  ask_again_at_ = now;
  store_rest(now);
}

void RobotLoop::store_rest(hal::Instant now) {
  if (now < ask_again_at_) return;
  ask_again_at_ = now + config_.inventory.retry_interval;
  const bool stored = sink_.flush(now);
  if (!stored && !waited(config_.limits.store_allowance, now)) return;
  if (!stored) {
    set_end(EndReason::store_failed, sink_.last_error(), now);
    fmt::memory_buffer line;
    fmt::format_to(std::back_inserter(line), "{} reads are not stored: {}", sink_.waiting(),
                   sink_.last_error());
    journal_->note(now, kSource, {line.data(), line.size()});
  }
  enter(MissionPhase::done, now);
}

}  // namespace forager::flight
