#include "flight/drive_loop.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "drive";

constexpr hal::Duration kMeasured = std::chrono::milliseconds(70);  // two frames of the camera

constexpr hal::Duration kRecovered = std::chrono::milliseconds(250);

bool rolls(servo::SteerPhase phase) {
  return phase == servo::SteerPhase::releasing || phase == servo::SteerPhase::driving ||
         phase == servo::SteerPhase::coasting;
}

}  // namespace

std::string_view to_string(DrivePhase phase) {
  constexpr std::array<std::string_view, 6> kNames{"waiting", "guided",   "arming",
                                                   "driving", "stopping", "done"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view to_string(DriveEnd end) {
  constexpr std::array<std::string_view, 14> kNames{
      "none",      "arrived",     "missed",        "emergency_stop", "deadman", "autopilot_lost", "pilot",
      "pose_lost", "brake_fault", "left_corridor", "no_motion",      "blocked", "refused",        "halted"};
  return kNames[static_cast<std::size_t>(end)];
}

DriveLoop::DriveLoop(const DriveConfig& config, const DriveDevices& devices, DriveMission mission,
                     hal::Instant now)
    : config_(config),
      autopilot_(&devices.autopilot),
      pose_(&devices.pose),
      journal_(&devices.journal),
      alive_(devices.alive),
      stop_button_(devices.stop_button),
      depth_(devices.depth),
      mission_(std::move(mission)),
      brakes_(devices.left_brake, devices.right_brake, devices.journal, config.brakes, now),
      steer_(config.steer),
      own_filter_(config.vision),
      filter_(devices.vision != nullptr ? devices.vision : &own_filter_),
      guard_(config.guard),
      interlocks_(devices.journal),
      deadman_(config.deadman) {
  status_.phase_since = now;
}

// pose -> steps -> brakes and thrust, with the safety core between the last two.
void DriveLoop::update(hal::Instant now) {
  alive_level_ = !alive_level_;
  if (alive_ != nullptr) {
    const auto set = alive_->set(alive_level_);  // a dead line ends in locked brakes
    note_first(alive_failed_, set ? nullptr : &set.error(), now);
  }
  if (done()) {
    brakes_.update(now);
    return;
  }
  sense(now);
  look(now);
  output_ = steer_.update(input_, now);
  note_steering(now);
  judge(now);
  run_phase(now);
  act(now);
  autopilot_->send(now);
}

// The first of failures in a row.
void DriveLoop::note_first(bool& failed, const hal::Error* error, hal::Instant now) {
  if (error != nullptr && !failed) journal_->note(now, kSource, hal::describe(*error));
  failed = error != nullptr;
}

void DriveLoop::sense(hal::Instant now) {
  deadman_.update(now);
  if (deadman_.alive()) autopilot_->feed_deadman(now);
  autopilot_->update(now);
  input_ = {};
  const auto sample = pose_->poll(now);
  note_first(pose_failed_, sample ? nullptr : &sample.error(), now);
  if (sample && *sample) {
    if (const auto passed = filter_->update(**sample, now)) autopilot_->send_vision(*passed);
    const auto& newest = filter_->newest();
    if (newest && newest->stamp > last_pose_) {
      last_pose_ = newest->stamp;
      input_.pose = newest;
    }
  }
  input_.yaw_rate_rad_s = autopilot_->take_yaw_rate();
  if (stop_button_ != nullptr) {
    const auto pressed = stop_button_->active();
    button_failed_ = !pressed;
    button_pressed_ = button_pressed_ || (pressed && *pressed);  // stays until the next mission
  }
}

// What stands in the way matters while it rolls, and then until it has gone.
void DriveLoop::look(hal::Instant now) {
  if (depth_ == nullptr) return;
  const auto frame = depth_->poll(now);
  note_first(depth_failed_, frame ? nullptr : &frame.error(), now);
  if (frame && *frame) guard_.check(**frame, status_.speed_m_s, status_.pose_world.pitch_rad, now);
  const bool clear = guard_.latest(now).way == WayAhead::clear;
  if (clear)
    blocked_ = false;
  else if (rolls(steer_.phase()))
    blocked_ = true;
}

void DriveLoop::judge(hal::Instant now) {
  const servo::MotionEstimate& estimate = steer_.estimate();
  const bool pose_fresh = estimate.known() && estimate.pose_age(now) <= config_.steer.pose_hold;
  if (estimate.known()) {
    status_.pose_world = estimate.pose();
    status_.speed_m_s = estimate.speed_m_s();
    status_.yaw_rate_rad_s = estimate.yaw_rate_rad_s();
    status_.corridor_m = mission_.corridor.distance_m(status_.pose_world.position);
    // Brakes are not judged by dead reckoning, nor while the estimate still recovers from it.
    if (estimate.pose_age(now) > kMeasured) measured_from_ = now;
    if (now - measured_from_ >= kRecovered) brakes_.observe({status_.speed_m_s, status_.yaw_rate_rad_s, now});
  }
  const AutopilotState& autopilot = autopilot_->state();
  was_armed_ = was_armed_ || (autopilot.armed && status_.phase == DrivePhase::driving);
  const bool ours = autopilot.guided && (autopilot.armed || !was_armed_);
  const servo::BrakeStatus& brakes = brakes_.status();
  const bool brakes_good =
      brakes.state == servo::BrakeState::engaged || brakes.state == servo::BrakeState::following;
  const bool inside =
      !estimate.known() || status_.corridor_m <= mission_.corridor.half_width_m() - config_.corridor_margin_m;
  const servo::SteerFault fault = steer_.fault();

  interlocks_.say(Interlock::emergency_stop, !button_pressed_ && !button_failed_ && !autopilot_->stop_heard(),
                  button_pressed_  ? "button pressed"
                  : button_failed_ ? "the button cannot be read"
                                   : "told over the link");
  interlocks_.say(Interlock::deadman, deadman_.alive());
  const hal::Instant heard = autopilot_->attitude_heard();
  const bool fresh = heard != hal::Instant::min() && now - heard <= config_.attitude_timeout;
  interlocks_.say(Interlock::autopilot_link, autopilot.link_up && fresh);
  interlocks_.say(Interlock::control, ours, autopilot.guided ? "disarmed" : "not in GUIDED");
  interlocks_.say(Interlock::pose, pose_fresh);
  interlocks_.say(Interlock::brakes, brakes_good, brakes.reason);
  interlocks_.say(Interlock::corridor, inside);
  interlocks_.say(Interlock::motion,
                  fault != servo::SteerFault::no_motion && fault != servo::SteerFault::runs_away &&
                      fault != servo::SteerFault::spins,
                  to_string(fault));
  interlocks_.say(Interlock::command, now < go_until_);
  interlocks_.say(Interlock::way_ahead, !blocked_);
  interlocks_.update(now);
}

void DriveLoop::run_phase(hal::Instant now) {
  switch (status_.phase) {
    case DrivePhase::waiting:
      return wait_for_links(now);
    case DrivePhase::guided:
      return wait_for_mode(now);
    case DrivePhase::arming:
      return wait_for_arming(now);
    case DrivePhase::driving:
      return drive(now);
    case DrivePhase::stopping:
      return stopping(now);
    case DrivePhase::done:
      return;
  }
}

void DriveLoop::note_steering(hal::Instant now) {
  if (steer_.phase() == noted_) return;
  noted_ = steer_.phase();
  const servo::MotionEstimate& estimate = steer_.estimate();
  fmt::basic_memory_buffer<char, 128> line;
  fmt::format_to(std::back_inserter(line), "{} step {} of {} at {:.3f} {:.3f} heading {:.1f}",
                 to_string(noted_), steer_.step() + 1, steer_.steps(), estimate.pose().position.x,
                 estimate.pose().position.y, hal::rad_to_deg(estimate.pose().yaw_rad));
  journal_->note(now, "steering", {line.data(), line.size()});
}

// Thrust and brakes of this update. What is not allowed is not merely left out: zero and locked are sent.
void DriveLoop::act(hal::Instant now) {
  const hal::Instant until = now + config_.command_life;
  const bool drives = status_.phase == DrivePhase::driving && interlocks_.may_thrust();
  brakes_.command(drives ? output_.brakes : servo::both_locked(until));
  brakes_.update(now);
  status_.thrust_allowed = drives && brakes_.thrust_allowed();
  if (status_.phase != DrivePhase::driving && status_.phase != DrivePhase::stopping) return;
  if (status_.end == DriveEnd::pilot) return autopilot_->clear_setpoint();
  AttitudeSetpoint setpoint;
  setpoint.yaw_rad = status_.pose_world.yaw_rad;
  setpoint.valid_until = until;
  if (status_.thrust_allowed) {
    setpoint.pitch_rad = output_.pitch_rad;
    setpoint.thrust = output_.thrust;
  }
  autopilot_->set_attitude(setpoint);
}

void DriveLoop::enter(DrivePhase phase, hal::Instant now) {
  status_.phase = phase;
  status_.phase_since = now;
  fmt::basic_memory_buffer<char, 64> line;
  fmt::format_to(std::back_inserter(line), "phase {}", to_string(phase));
  journal_->note(now, kSource, {line.data(), line.size()});
}

bool DriveLoop::waited(hal::Duration allowed, hal::Instant now) const {
  return now - status_.phase_since >= allowed;
}

void DriveLoop::halt() noexcept {
  halt_asked_ = true;
  brakes_.halt();
  if (status_.end == DriveEnd::pilot) return;  // it is theirs, and may be anywhere
  if (status_.phase == DrivePhase::guided || status_.phase == DrivePhase::arming) landing_asked_ = true;
  autopilot_->halt();
}

}  // namespace forager::flight
