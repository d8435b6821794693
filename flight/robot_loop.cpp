#include "flight/robot_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "mission";
constexpr double kHeightReachedM = 0.3;
constexpr hal::Duration kAskAgain = std::chrono::seconds(2);
// Long enough before a window ends that a fresh frame is at hand when it is decided on.
constexpr hal::Duration kLookAhead = std::chrono::milliseconds(250);

std::string_view view(const fmt::memory_buffer& line) { return {line.data(), line.size()}; }

std::string_view landing_text(EndReason why) {
  switch (why) {
    case EndReason::no_new_tags:
      return "window after window without a new tag";
    case EndReason::path_complete:
      return "the path has been flown";
    case EndReason::time_limit:
      return "the time for it is over";
    default:
      return "the policy wants to land";
  }
}

}  // namespace

RobotLoop::RobotLoop(RobotLoopConfig config, const RobotDevices& devices, Policy& policy)
    : config_(std::move(config)),
      autopilot_(&devices.autopilot),
      reader_(&devices.reader),
      depth_(&devices.depth),
      journal_(&devices.journal),
      lamp_(devices.lamp),
      policy_(&policy),
      localisation_(devices.pose, devices.autopilot, devices.journal, config_.vision),
      sink_(devices.store, devices.journal, config_.inventory),
      intake_(config_.ports, config_.share, config_.expected_tags, sink_),
      guard_(config_.guard),
      flight_(config_.step) {
  status_.decisions.reserve(config_.expected_decisions);
}

// The whole sentence: bytes -> reads -> new-tag weights -> heading -> setpoints.
void RobotLoop::update(hal::Instant now) {
  if (done()) return;
  sense(now);
  look(now);
  run_phase(now);
  report(now);
}

void RobotLoop::sense(hal::Instant now) {
  if (!started_) {
    started_ = true;
    status_.phase_since = now;
    reader_->start(now);
  }
  if (status_.phase != MissionPhase::silent) autopilot_->feed_deadman(now);
  autopilot_->update(now);
  reader_->update(now);
  localisation_.update(now);
  if (localisation_.take_reset()) follow_reset();
  if (const auto pose = localisation_.pose_world()) {
    pose_world_ = *pose;
    status_.pose_world = pose;
    if (status_.took_off && !status_.touched_down) path_.add(now, *pose);
  }
  intake_.take(reader_->reads(), localisation_.history());
  if (reader_->link().reading())
    reader_lost_since_.reset();
  else if (!reader_lost_since_)
    reader_lost_since_ = now;
}

// The camera is asked only when what it sees matters: before and during a way, and for the next decision.
void RobotLoop::look(hal::Instant now) {
  const bool decides_soon =
      status_.phase == MissionPhase::listening && window_open_ && now >= window_ends_ - kLookAhead;
  if (flight_.watching() || decides_soon) {
    const auto frame = depth_->poll(now);
    if (!frame && !depth_failed_) journal_->note(now, "depth", hal::describe(frame.error()));
    depth_failed_ = !frame;
    if (frame && *frame) {
      const hal::Vec3 v = autopilot_->state().velocity_world_m_s;
      const double forward = v.x * std::cos(pose_world_.yaw_rad) + v.y * std::sin(pose_world_.yaw_rad);
      guard_.check(**frame, std::max(forward, flight_.planned_speed_m_s()), pose_world_.pitch_rad, now);
    }
  }
  way_ = guard_.latest(now);
  // Without knowing where it is, it does not know along which way it looks.
  if (!localisation_.healthy()) way_.way = WayAhead::blind;
}

void RobotLoop::run_phase(hal::Instant now) {
  switch (status_.phase) {
    case MissionPhase::waiting:
      return wait_for_links(now);
    case MissionPhase::guided:
      return wait_for_mode(now);
    case MissionPhase::arming:
      return wait_for_arming(now);
    case MissionPhase::takeoff:
      if (obey_limits(now)) climb(now);
      return;
    case MissionPhase::listening:
      if (obey_limits(now)) listen(now);
      return;
    case MissionPhase::stepping:
      if (obey_limits(now)) step(now);
      return;
    case MissionPhase::landing:
      return land(now);
    case MissionPhase::silent:
      return stay_silent(now);
    case MissionPhase::storing:
      return store_rest(now);
    case MissionPhase::done:
      return;
  }
}

void RobotLoop::climb(hal::Instant now) {
  if (autopilot_->request_state() == RequestState::refused)
    return start_landing(EndReason::refused, autopilot_->request_detail(), now);
  if (waited(config_.limits.takeoff_timeout, now))
    return start_landing(EndReason::refused, "did not reach its height", now);
  if (pose_world_.position.z < floor_z_m_ + config_.takeoff_height_m - kHeightReachedM) return;
  hal::Pose hover = pose_world_;
  hover.position.z = floor_z_m_ + config_.takeoff_height_m;
  flight_.hold(hover);
  begin_step(policy_->begin(pose_world_), now);
}

void RobotLoop::begin_step(const Step& step, hal::Instant now) {
  step_ = step;
  blocked_ = false;
  flight_.begin(step_, pose_world_, floor_z_m_, now);
  enter(MissionPhase::stepping, now);
  this->step(now);
}

void RobotLoop::step(hal::Instant now) {
  const StepOutcome outcome = flight_.update(pose_world_, autopilot_->state().velocity_world_m_s, way_, now);
  autopilot_->set_position(flight_.setpoint(now));
  if (outcome == StepOutcome::flying) return;
  blocked_ = outcome == StepOutcome::blocked;
  if (outcome != StepOutcome::arrived) {
    fmt::memory_buffer line;
    fmt::format_to(std::back_inserter(line), "{} after {:.2f} m, way {} {:.2f} m {}",
                   blocked_ ? "blocked" : "late", flight_.moved_m(), to_string(way_.way), way_.range_m,
                   way_.reason);
    journal_->note(now, kSource, view(line));
  }
  open_window(now);
}

void RobotLoop::open_window(hal::Instant now) {
  drop_reads_ = flight_.changed_pose();
  window_open_ = false;
  window_opens_ =
      now + (drop_reads_ && step_.listen > hal::Duration::zero() ? config_.settle : hal::Duration::zero());
  if (step_.listen > hal::Duration::zero()) ++status_.window;
  enter(MissionPhase::listening, now);
}

void RobotLoop::listen(hal::Instant now) {
  autopilot_->set_position(flight_.setpoint(now));
  if (!window_open_) {
    if (now < window_opens_) return;
    if (drop_reads_) intake_.drop_window();
    window_open_ = true;
    window_ends_ = now + step_.listen;
    if (!first_window_) first_window_ = now;
  }
  if (reader_lost_since_) window_ends_ = now + step_.listen;  // silence of the reader is not absence of tags
  if (now >= window_ends_ && !reader_lost_since_) decide(now);
}

Observation RobotLoop::observe(const ClosedWindow& window, hal::Instant now) const {
  Observation seen;
  seen.now = now;
  seen.elapsed = now - *first_window_;
  seen.pose_world = pose_world_;
  seen.weights = window.weights;
  seen.new_tags = window.new_tags;
  seen.fresh_tags = window.fresh_tags;
  seen.tries = status_.tries;
  seen.way_ahead = way_.way;
  seen.blocked = blocked_;
  seen.moved_m = flight_.moved_m();
  seen.window = status_.window;
  return seen;
}

void RobotLoop::decide(hal::Instant now) {
  const ClosedWindow window = intake_.close_window();
  if (window.fresh_tags > 0)
    status_.tries = 0;
  else if (step_.listen > hal::Duration::zero())
    ++status_.tries;
  const Step next = policy_->decide(observe(window, now));
  if (!next.consume_tags) intake_.keep_window();
  status_.decisions.push_back({.at = now,
                               .kind = next.kind,
                               .from = pose_world_,
                               .heading_rad = next.heading_rad,
                               .step_m = next.length_m,
                               .new_tags = window.new_tags});
  note_window(window, now);
  if (next.kind == DecisionKind::land) return start_landing(next.end, landing_text(next.end), now);
  begin_step(next, now);
}

void RobotLoop::note_window(const ClosedWindow& window, hal::Instant now) const {
  const Decision& decision = status_.decisions.back();
  fmt::memory_buffer line;
  fmt::format_to(std::back_inserter(line), "window {}:", status_.window);
  for (const reader::PortWeight& port : window.weights)
    fmt::format_to(std::back_inserter(line), " {:.3g}", port.weight);
  fmt::format_to(std::back_inserter(line), " -> {} {:.1f}", to_string(decision.kind),
                 hal::rad_to_deg(hal::angle_difference(decision.heading_rad, decision.from.yaw_rad)));
  journal_->note(now, kSource, view(line));
}

// The world frame has moved under us: keep the place we are at, whatever it is called now.
void RobotLoop::follow_reset() {
  if (status_.phase != MissionPhase::listening && status_.phase != MissionPhase::stepping) return;
  const hal::Pose moved = *localisation_.pose_world();
  floor_z_m_ += moved.position.z - pose_world_.position.z;
  flight_.hold(moved);
}

void RobotLoop::report(hal::Instant now) {
  sink_.update(now);
  signal(now);
  status_.reads = intake_.reads();
  status_.unique_tags = intake_.unique_tags();
  status_.path_m = path_.length_m();
  status_.battery_fraction = autopilot_->state().battery_fraction;
}

void RobotLoop::signal(hal::Instant now) {
  const bool wanted = autopilot_->state().armed;
  if (lamp_ == nullptr || wanted == lamp_on_ || now < lamp_retry_at_) return;
  if (auto set = lamp_->set(wanted); set) {
    lamp_on_ = wanted;
  } else {
    lamp_retry_at_ = now + kAskAgain;
    journal_->note(now, kSource, hal::describe(set.error()));
  }
}

}  // namespace forager::flight
