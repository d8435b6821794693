#include "servo/brakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::servo {
namespace {

constexpr std::string_view kSource = "brakes";

bool fresh(const std::optional<VehicleMotion>& motion, hal::Duration max_age, hal::Instant now) {
  return motion && motion->at <= now && now - motion->at <= max_age && std::isfinite(motion->forward_m_s) &&
         std::isfinite(motion->yaw_rate_rad_s);
}

}  // namespace

std::string_view to_string(BrakeState state) {
  switch (state) {
    case BrakeState::engaged:
      return "engaged";
    case BrakeState::following:
      return "following";
    case BrakeState::faulted:
      return "faulted";
    case BrakeState::halted:
      return "halted";
  }
  return "unknown";
}

BrakePair::BrakePair(BrakeActuator& left, BrakeActuator& right, hal::Journal& journal,
                     const BrakePairConfig& config, hal::Instant now)
    : left_{&left,
            BrakeWatch(BrakeSide::left, config.watch),
            BrakeHeatModel(config.heat),
            &status_.left,
            &status_.left_heat,
            &status_.left_fraction},
      right_{&right,
             BrakeWatch(BrakeSide::right, config.watch),
             BrakeHeatModel(config.heat),
             &status_.right,
             &status_.right_heat,
             &status_.right_fraction},
      journal_(&journal),
      config_(config),
      now_(now) {
  left.halt();
  right.halt();
  left_.watch.reset(now);
  right_.watch.reset(now);
  enter(BrakeState::engaged, "start", now);
}

BrakePair::~BrakePair() { halt(); }

void BrakePair::command(const BrakeCommand& command) {
  if (status_.state == BrakeState::faulted || status_.state == BrakeState::halted) return;
  command_ = command;
  if (!std::isfinite(command.left) || !std::isfinite(command.right)) command_.left = command_.right = 1.0;
}

void BrakePair::observe(const VehicleMotion& motion) { motion_ = motion; }

void BrakePair::update(hal::Instant now) {
  now_ = now;
  decide(now);
  move(left_, Pace::slewed, now);
  move(right_, Pace::slewed, now);
  if (status_.state == BrakeState::engaged || status_.state == BrakeState::following) {
    watch(left_, right_, now);
    watch(right_, left_, now);
  }
  const bool found = *left_.fault || *right_.fault;
  if (found && (status_.state == BrakeState::engaged || status_.state == BrakeState::following)) {
    begin_fault(now);
    decide(now);
    move(left_, Pace::at_once, now);  // in this update: the time for a slewed step is used up
    move(right_, Pace::at_once, now);
  }
  warm(left_, "left", now);
  warm(right_, "right", now);
}

void BrakePair::enter(BrakeState state, std::string_view reason, hal::Instant now) {
  status_.state = state;
  status_.cut_thrust = state != BrakeState::following;
  status_.reason = reason;
  journal_->note(now, kSource, fmt::format("{}: {}", to_string(state), reason));
}

void BrakePair::begin_fault(hal::Instant now) {
  faulted_at_ = now;
  stopped_ = false;
  command_ = {};
  const auto words = [](std::string_view side, const BrakeFault& fault) {
    return fault ? fmt::format("{} brake, {}: {}; ", side, to_string(fault.kind), fault.detail)
                 : std::string();
  };
  const bool both = status_.left && status_.right;
  enter(BrakeState::faulted,
        words("left", status_.left) + words("right", status_.right) +
            (both ? "no brake is left, thrust must go" : "stopping with the other one, thrust must go"),
        now);
}

void BrakePair::decide(hal::Instant now) {
  left_.wanted = right_.wanted = 1.0;
  const bool commanded = now < command_.valid_until;
  if (status_.state == BrakeState::engaged && commanded)
    enter(BrakeState::following, "a fresh command", now);
  else if (status_.state == BrakeState::following && !commanded)
    enter(BrakeState::engaged, "the command ran out", now);
  if (status_.state == BrakeState::following) {
    left_.wanted = std::clamp(command_.left, 0.0, 1.0);
    right_.wanted = std::clamp(command_.right, 0.0, 1.0);
  } else if (status_.state == BrakeState::faulted) {
    decide_faulted(now);
  }
}

void BrakePair::decide_faulted(hal::Instant now) {
  const bool known = fresh(motion_, config_.watch.motion_max_age, now);
  if (!stopped_ && (now - faulted_at_ >= config_.stop_time || (known && standing()))) {
    stopped_ = true;
    journal_->note(now, kSource, "faulted: standing, or time is up: locked for good");
  }
  if (stopped_ || (status_.left && status_.right)) return;
  const bool good_is_left = !status_.left;
  (good_is_left ? left_ : right_).wanted = may_press(good_is_left, known, now) ? 1.0 : 0.0;
}

bool BrakePair::standing() const {
  const double turning_m_s = std::abs(motion_->yaw_rate_rad_s) * config_.watch.half_track_m;
  return std::abs(motion_->forward_m_s) + turning_m_s <= config_.standstill_m_s;
}

// Whether the good brake may hold now without turning the stop into a spin about its wheel.
bool BrakePair::may_press(bool left, bool motion_known, hal::Instant now) const {
  if (!motion_known) return (now - faulted_at_) % config_.blind_period < config_.blind_press;
  const double towards_rad_s = left ? motion_->yaw_rate_rad_s : -motion_->yaw_rate_rad_s;
  return towards_rad_s <= config_.yaw_limit_rad_s;
}

void BrakePair::move(Side& side, Pace pace, hal::Instant now) {
  if (*side.fault && now >= side.tell_again_at) {
    side.actuator->forget();
    side.tell_again_at = now + config_.tell_again;
  }
  const hal::Result<> moved =
      pace == Pace::at_once ? side.actuator->jump(side.wanted, now) : side.actuator->move(side.wanted, now);
  side.watch.saw(side.actuator->commanded(), side.actuator->measured(), now);
  *side.fraction = side.actuator->commanded();
  if (moved || *side.fault) return;
  *side.fault = {BrakeFaultKind::output, describe(moved.error()), now};
  if (status_.state == BrakeState::faulted || status_.state == BrakeState::halted)
    journal_->note(now, kSource, fmt::format("{}, too: {}", to_string(status_.state), side.fault->detail));
}

void BrakePair::watch(Side& side, const Side& other, hal::Instant now) {
  if (*side.fault) return;
  const BrakeFaultKind kind = side.watch.judge(motion_, other.actuator->commanded(), now);
  if (kind != BrakeFaultKind::none) *side.fault = {kind, side.watch.detail(kind), now};
}

void BrakePair::halt() noexcept {
  left_.actuator->halt();
  right_.actuator->halt();
  if (status_.state == BrakeState::halted) return;
  command_ = {};
  try {
    enter(BrakeState::halted, "halt", now_);
  } catch (...) {
    status_.state = BrakeState::halted;  // out of memory: the brakes are locked, only the line is lost
    status_.cut_thrust = true;
  }
}

void BrakePair::resume(hal::Instant now) {
  if (status_.state != BrakeState::halted) return;
  enter(BrakeState::engaged, "resumed", now);
  left_.watch.reset(now);
  right_.watch.reset(now);
}

hal::Result<> BrakePair::clear_fault(hal::Instant now) {
  if (status_.state != BrakeState::faulted)
    return hal::fail(hal::ErrorCode::invalid_state, "brakes", "clear fault",
                     fmt::format("they are {}, not faulted", to_string(status_.state)));
  status_.left = {};
  status_.right = {};
  for (Side* const side : {&left_, &right_}) {
    side->watch.reset(now);
    side->actuator->forget();
  }
  enter(BrakeState::engaged, "the fault was cleared", now);
  return {};
}

void BrakePair::warm(Side& side, std::string_view name, hal::Instant now) {
  if (side.heat.update(side.actuator->commanded(), now))
    journal_->note(now, kSource,
                   fmt::format("{} brake: {}", name,
                               side.heat.state().rest_advised
                                   ? "hot or locked for long: stop and take the load off, it stays locked"
                                   : "cool again"));
  *side.told_heat = side.heat.state();
}

}  // namespace forager::servo
