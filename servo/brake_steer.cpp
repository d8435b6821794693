#include "servo/brake_steer.hpp"

#include <algorithm>
#include <cmath>

namespace forager::servo {
namespace {

constexpr double kStandingSpeed = 0.03;    // m/s
constexpr double kStandingYawRate = 0.04;  // rad/s
constexpr hal::Duration kSticks = std::chrono::milliseconds(800);
constexpr double kPitchGain = 4.0;  // 1/s, speed by pitch

// Towards zero, and not beyond it within an update.
double slowing(double speed, double brake) {
  constexpr double kUpdate = 0.02;  // s
  return -std::copysign(std::min(brake, std::abs(speed) / kUpdate), speed);
}

}  // namespace

std::string_view to_string(SteerPhase phase) {
  constexpr std::array<std::string_view, 10> kNames{"idle",      "holding",   "settling", "turning",
                                                    "turn_ends", "releasing", "driving",  "coasting",
                                                    "arrived",   "failed"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view to_string(SteerFault fault) {
  constexpr std::array<std::string_view, 8> kNames{"none",      "no_motion",   "spins", "runs_away",
                                                   "pose_lost", "unreachable", "late",  "missed"};
  return kNames[static_cast<std::size_t>(fault)];
}

BrakeSteer::BrakeSteer(const BrakeSteerConfig& config)
    : config_(config), estimate_(config.estimate), learnt_(config.start) {}

hal::Result<> BrakeSteer::usable(std::span<const SteerStep> steps, std::optional<double> goal_heading_rad) {
  const auto refuse = [](const char* why) {
    return hal::fail(hal::ErrorCode::invalid_argument, "brake steering", "begin", why,
                     "Give at least one step with finite coordinates in metres.");
  };
  if (steps.empty()) return refuse("there is no step to go to");
  for (const SteerStep& step : steps)
    if (!std::isfinite(step.x_m) || !std::isfinite(step.y_m)) return refuse("a step is not finite");
  if (goal_heading_rad && !std::isfinite(*goal_heading_rad))
    return refuse("the goal's heading is not finite");
  return {};
}

hal::Result<> BrakeSteer::begin(std::span<const SteerStep> steps, std::optional<double> goal_heading_rad,
                                hal::Instant now) {
  FORAGER_TRY(usable(steps, goal_heading_rad));
  steps_.assign(steps.begin(), steps.end());
  goal_heading_rad_ = goal_heading_rad;
  step_ = 0;
  tries_ = 0;
  fault_ = SteerFault::none;
  leg_since_ = now;
  enter(SteerPhase::settling, now);
  return {};
}

void BrakeSteer::fail(SteerFault fault) {
  if (phase_ == SteerPhase::failed) return;
  fault_ = fault;
  phase_ = SteerPhase::failed;
}

SteerOutput BrakeSteer::update(const SteerInput& input, hal::Instant now) {
  expect(now);
  if (input.yaw_rate_rad_s) estimate_.take_yaw_rate(*input.yaw_rate_rad_s);
  if (input.pose) static_cast<void>(estimate_.take(*input.pose));
  const bool stands = std::abs(estimate_.speed_m_s()) < kStandingSpeed &&
                      std::abs(estimate_.yaw_rate_rad_s()) < kStandingYawRate;
  if (!stands)
    still_since_.reset();
  else if (!still_since_)
    still_since_ = now;
  if (phase_ != SteerPhase::idle && !done() && may_move(now)) run(now);
  return output(now);
}

// What the estimate is to expect until the next update, from what it is being told to do.
void BrakeSteer::expect(hal::Instant now) {
  double accel = 0.0;
  double yaw_accel = 0.0;
  const double sign = side_ == Brake::right ? -1.0 : 1.0;
  const bool pushes = hal::to_seconds(now - since_) > config_.thrust_lag_s;
  switch (phase_) {
    case SteerPhase::driving:
      if (pushes && !config_.speed_by_pitch) accel = learnt_.push_m_s2;
      break;
    case SteerPhase::coasting:
      if (pushes && !config_.speed_by_pitch && estimate_.speed_m_s() > 0.1) accel = -learnt_.coast_m_s2;
      break;
    case SteerPhase::turning:
      if (pushes && !config_.speed_by_pitch) yaw_accel = sign * learnt_.turn_push_rad_s2;
      break;
    case SteerPhase::turn_ends:
      if (pushes && !config_.speed_by_pitch && std::abs(estimate_.yaw_rate_rad_s()) > 0.1)
        yaw_accel = -std::copysign(learnt_.turn_coast_rad_s2, estimate_.yaw_rate_rad_s());
      break;
    case SteerPhase::settling:
    case SteerPhase::holding:
      // Both brakes grip: it slows down whether a camera sees it or not, and then stands.
      if (hal::to_seconds(now - since_) > learnt_.stop_lag_s) {
        accel = slowing(estimate_.speed_m_s(), config_.brake_m_s2);
        yaw_accel = slowing(estimate_.yaw_rate_rad_s(), config_.turn_brake_rad_s2);
      }
      break;
    default:
      break;
  }
  const bool turns = phase_ == SteerPhase::turning || phase_ == SteerPhase::turn_ends;
  estimate_.predict(now, turns ? sign * config_.half_track_m * yaw_accel : accel, yaw_accel);
}

// False: it holds, both brakes locked. The geometry stays; it is planned anew from where it stands then.
bool BrakeSteer::may_move(hal::Instant now) {
  const hal::Duration age = estimate_.pose_age(now);
  if (age > config_.pose_lost && now - since_ > config_.pose_lost) {
    fail(SteerFault::pose_lost);
    return false;
  }
  const bool frame_moved = estimate_.resets() != resets_;
  resets_ = estimate_.resets();
  const bool stop = now >= valid_until_ || age > config_.pose_hold || frame_moved;
  if (stop) {
    if (phase_ != SteerPhase::holding) {
      if (phase_ != SteerPhase::settling) ++stats_.holds;
      enter(SteerPhase::holding, now);
    }
    return false;
  }
  if (phase_ == SteerPhase::holding) {
    leg_since_ = now;
    stop_mark_.set = false;
    enter(SteerPhase::settling, now);
  }
  return true;
}

void BrakeSteer::run(hal::Instant now) {
  watch(now);
  if (done()) return;
  switch (phase_) {
    case SteerPhase::settling:
      return settle(now);
    case SteerPhase::turning:
    case SteerPhase::turn_ends:
      return turn(now);
    case SteerPhase::releasing:
    case SteerPhase::driving:
    case SteerPhase::coasting:
      return drive(now);
    default:
      return;
  }
}

void BrakeSteer::enter(SteerPhase phase, hal::Instant now) {
  phase_ = phase;
  since_ = now;
  runaway_since_.reset();
  rate_mark_.set = false;
}

BrakeSteer::Aim BrakeSteer::aim_at(const SteerStep& step) const {
  const hal::Pose& at = estimate_.pose();
  const double dx = step.x_m - at.position.x;
  const double dy = step.y_m - at.position.y;
  const double c = std::cos(at.yaw_rad);
  const double s = std::sin(at.yaw_rad);
  Aim aim;
  aim.ahead_m = c * dx + s * dy;
  aim.left_m = c * dy - s * dx;
  aim.distance_m = std::hypot(dx, dy);
  aim.bearing_rad = std::atan2(aim.left_m, aim.ahead_m);
  return aim;
}

// The pitch that gives the wanted speed: the force goes with its sine, `push` being what the fixed pitch
// gives net of `coast`.
double BrakeSteer::pitch_for_speed(double wanted, double speed, double push, double coast,
                                   hal::Instant now) const {
  const double gross = push + coast;
  const bool sticks = stuck_since_ && now - *stuck_since_ > kSticks;  // more friction than it knows of
  if (!(gross > 0.0) || sticks) return config_.pitch_rad;
  const double share = std::clamp((kPitchGain * (wanted - speed) + coast) / gross, 0.0, 1.0);
  return std::asin(share * std::sin(config_.pitch_rad));
}

SteerOutput BrakeSteer::output(hal::Instant now) const {
  const hal::Instant until = now + config_.command_life;
  SteerOutput out;
  out.brakes = both_locked(until);
  out.pitch_rad = config_.pitch_rad;
  const bool rolls =
      phase_ == SteerPhase::releasing || phase_ == SteerPhase::driving || phase_ == SteerPhase::coasting;
  const bool turns = phase_ == SteerPhase::turning || phase_ == SteerPhase::turn_ends;
  if (rolls && !checking_speed_) out.brakes = both_open(until);
  if (rolls && dab_ != Brake::none && now < dab_until_)
    out.brakes = dab_ == Brake::left ? left_locked(until) : right_locked(until);
  if (turns) out.brakes = side_ == Brake::left ? left_locked(until) : right_locked(until);
  if (config_.speed_by_pitch) {
    // Thrust stays as it is as long as it is under way; the body stands upright where it is not to push.
    const bool under_way = rolls || turns || phase_ == SteerPhase::settling;
    out.thrust = under_way ? config_.thrust : 0.0;
    out.pitch_rad = under_way && !checking_speed_ ? pitch_command_ : 0.0;
  } else if (phase_ == SteerPhase::turning || (phase_ == SteerPhase::driving && !checking_speed_)) {
    out.thrust = config_.thrust;
  }
  return out;
}

}  // namespace forager::servo
