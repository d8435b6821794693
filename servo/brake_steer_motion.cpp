// What to do while it moves, and what is learnt from it.
#include <algorithm>
#include <cmath>

#include "servo/brake_steer.hpp"

namespace forager::servo {
namespace {

constexpr double kLearn = 0.35;        // weight of a new observation
constexpr double kTurnDone = 0.010;    // rad
constexpr double kSlow = 0.05;         // m/s
constexpr double kSlowTurn = 0.06;     // rad/s
constexpr double kReplanAbove = 0.30;  // m to go; nearer than this it is not worth stopping for
constexpr double kSpinning = 0.35;     // rad/s with both brakes open
constexpr double kOffLine = 0.06;      // m beyond what was planned for
constexpr double kDabSpeed = 0.12;     // m/s; slower, a touch would stop it
constexpr double kDabAbove = 0.7;      // of a touch
constexpr hal::Duration kDabShows = std::chrono::milliseconds(250);  // servo and pad are back by then
constexpr double kTooMuch = 0.7;
constexpr int kMostSpins = 4;
constexpr double kMovedM = 0.03;
constexpr double kMovedRad = 0.05;
constexpr double kNearGoal = 0.03;     // m
constexpr double kSpeedMargin = 0.12;  // m/s above the limit until it brakes for it

double blend(double old_value, double seen, double low, double high) {
  return std::clamp(old_value + kLearn * (seen - old_value), low, high);
}

}  // namespace

// Angle still to turn, towards the braked side; from the pose, so slipping of the locked wheel is in it.
double BrakeSteer::angle_left() const {
  const double sign = side_ == Brake::right ? -1.0 : 1.0;
  if (to_heading_) return sign * hal::angle_difference(*goal_heading_rad_, estimate_.pose().yaw_rad);
  const Aim here = aim_at(steps_[step_]);
  const double off = std::clamp(-0.5 * learnt_.bend_rad_m * here.distance_m, -0.12, 0.12);
  const double x = std::cos(off) * here.ahead_m - std::sin(off) * here.left_m;
  const double y = sign * (std::sin(off) * here.ahead_m + std::cos(off) * here.left_m);
  const double q = x * x + y * (y - 2.0 * config_.half_track_m);
  const double angle = 2.0 * std::atan2(y, x + std::sqrt(std::max(0.0, q)));
  // Of the angles that face the step, the one that goes on from the last: a turn may be nearly a full circle,
  // and a little too far is a small negative one.
  return angle + 2.0 * hal::kPi * std::round((turn_left_ - angle) / (2.0 * hal::kPi));
}

void BrakeSteer::turn(hal::Instant now) {
  const double sign = side_ == Brake::right ? -1.0 : 1.0;
  const double rate = sign * estimate_.yaw_rate_rad_s();
  turn_left_ = angle_left();
  const double to_go = turn_left_;
  const double lag = learnt_.turn_stop_lag_s[side_ == Brake::right ? 1 : 0];
  const double stop = std::max(0.0, rate) * lag + rate * rate / (2.0 * config_.turn_brake_rad_s2);
  learn_rates(now);
  pitch_command_ = config_.pitch_rad;
  if (config_.speed_by_pitch) {
    const double arrive = config_.arrive_yaw_rate_rad_s;
    const double wanted = std::min(
        config_.max_yaw_rate_rad_s,
        std::sqrt(0.25 * arrive * arrive + 2.0 * learnt_.turn_coast_rad_s2 * std::max(0.0, to_go - stop)));
    pitch_command_ = pitch_for_speed(wanted, rate, learnt_.turn_push_rad_s2, learnt_.turn_coast_rad_s2, now);
  }
  if (to_go <= stop + kTurnDone || rate > 1.5 * config_.max_yaw_rate_rad_s) {
    stop_mark_ = {now, 0.0, rate, estimate_.pose(), true};
    return enter(SteerPhase::settling, now);
  }
  if (config_.speed_by_pitch) return;
  if (phase_ == SteerPhase::turning) {
    // After the cut it pushes on for the lag and then coasts down to the rate the brakes take over at.
    const double gained = learnt_.turn_push_rad_s2 * config_.thrust_lag_s;
    const double then = rate + gained;
    const double arrive = config_.arrive_yaw_rate_rad_s;
    const double coast = std::max(0.0, then * then - arrive * arrive) / (2.0 * learnt_.turn_coast_rad_s2);
    const double reach = std::min(then, arrive);
    const double braking = reach * lag + reach * reach / (2.0 * config_.turn_brake_rad_s2);
    const double lagging = (rate + 0.5 * gained) * config_.thrust_lag_s;
    if (rate > config_.max_yaw_rate_rad_s || to_go <= lagging + coast + braking)
      enter(SteerPhase::turn_ends, now);
  } else if (rate < kSlowTurn && now - since_ > config_.settle) {
    enter(SteerPhase::turning, now);
  }
}

void BrakeSteer::drive(hal::Instant now) {
  const Aim here = aim_at(drive_to_);
  const double speed = estimate_.speed_m_s();
  const double stop = std::max(0.0, speed) * learnt_.stop_lag_s + speed * speed / (2.0 * config_.brake_m_s2);
  learn_rates(now);
  const auto lock = [&] {
    stop_mark_ = {now, speed, 0.0, estimate_.pose(), true};
    enter(SteerPhase::settling, now);
  };
  pitch_command_ = config_.pitch_rad;
  if (config_.speed_by_pitch) {
    const double arrive = config_.arrive_speed_m_s;
    const double wanted = std::min(
        config_.max_speed_m_s,
        std::sqrt(0.25 * arrive * arrive + 2.0 * learnt_.coast_m_s2 * std::max(0.0, here.ahead_m - stop)));
    pitch_command_ = pitch_for_speed(wanted, speed, learnt_.push_m_s2, learnt_.coast_m_s2, now);
  }
  if (phase_ == SteerPhase::releasing) {
    if (now - since_ >= config_.release) enter(SteerPhase::driving, now);
    if (speed > config_.arrive_speed_m_s) enter(SteerPhase::coasting, now);  // downhill
    return;
  }
  if (here.ahead_m <= stop + kNearGoal) {
    spins_ = 0;
    if (!roll_first_ && pass_on(here)) return;
    return lock();
  }
  const bool off_line = std::abs(miss_of(here)) > leg_miss_m_ + kOffLine && here.ahead_m > kReplanAbove;
  const bool spins = std::abs(estimate_.yaw_rate_rad_s()) > kSpinning;
  if ((off_line && !roll_first_) || spins) {
    ++stats_.replans;
    // A touch that was too much; or nothing was touched, and it spins all the same.
    if (spins && dab_open_)
      learnt_.dab_s[dab_ == Brake::right ? 1 : 0] *= kTooMuch;
    else if (spins && ++spins_ >= kMostSpins)
      return fail(SteerFault::spins);
    return lock();
  }
  keep_line(here, now);
  if (!checking_speed_ && speed > config_.max_speed_m_s + kSpeedMargin) {
    checking_speed_ = true;
    ++stats_.speed_checks;
  } else if (checking_speed_ && speed < 0.8 * config_.max_speed_m_s) {
    checking_speed_ = false;
  }
  if (config_.speed_by_pitch) return;
  if (phase_ == SteerPhase::driving) {
    const double gained = learnt_.push_m_s2 * config_.thrust_lag_s;
    const double then = speed + gained;
    const double arrive = config_.arrive_speed_m_s;
    const double coast = std::max(0.0, then * then - arrive * arrive) / (2.0 * learnt_.coast_m_s2);
    const double reach = std::min(then, arrive);
    const double braking = reach * learnt_.stop_lag_s + reach * reach / (2.0 * config_.brake_m_s2);
    const double lagging = (speed + 0.5 * gained) * config_.thrust_lag_s;
    if (speed > config_.max_speed_m_s || here.ahead_m <= lagging + coast + braking)
      enter(SteerPhase::coasting, now);
  } else if (speed < kSlow && now - since_ > config_.settle) {
    enter(SteerPhase::driving, now);
  }
}

// At what distance it will pass the target if its way goes on bending as it does: left positive.
double BrakeSteer::miss_of(const Aim& aim) const {
  return aim.left_m - 0.5 * learnt_.bend_rad_m * aim.ahead_m * std::abs(aim.ahead_m);
}

// Touches a brake for a moment to turn a rolling vehicle a little. How long a touch must be depends on the
// servo's lag and where its pad begins to grip, so it is learnt from what the gyro shows after each.
void BrakeSteer::keep_line(const Aim& here, hal::Instant now) {
  if (config_.dab_rad_s <= 0.0) return;
  const double rate = estimate_.yaw_rate_rad_s();
  if (dab_open_ && now >= dab_judged_) {
    dab_open_ = false;
    const bool right = dab_ == Brake::right;
    const double got = (right ? -1.0 : 1.0) * (rate - dab_from_);
    double& length = learnt_.dab_s[right ? 1 : 0];
    const double factor = std::clamp(std::sqrt(config_.dab_rad_s / std::max(0.02, got)), 0.75, 1.25);
    length = std::clamp(length * factor, 0.01, 0.3);
    dab_ = Brake::none;
  }
  if (now < dab_judged_ || checking_speed_ || estimate_.speed_m_s() < kDabSpeed) return;
  const double far = std::max(0.25, here.ahead_m);
  const double wanted = std::clamp(config_.heading_gain_1_s * here.left_m / far, -2.0 * config_.dab_rad_s,
                                   2.0 * config_.dab_rad_s);
  const double off = wanted - rate;
  if (std::abs(off) < kDabAbove * config_.dab_rad_s) return;
  dab_ = off > 0.0 ? Brake::left : Brake::right;
  const double length = learnt_.dab_s[dab_ == Brake::right ? 1 : 0];
  dab_until_ = now + hal::from_seconds(length);
  dab_judged_ = dab_until_ + kDabShows;
  dab_from_ = rate;
  dab_open_ = true;
  ++stats_.dabs;
}

// At a step that is not the goal: on to the next without stopping if it lies straight ahead.
bool BrakeSteer::pass_on(const Aim& here) {
  if (last_step() || std::abs(here.left_m) > 2.0 * config_.step_miss_m) return false;
  const Aim next = aim_at(steps_[step_ + 1]);
  const bool goal = step_ + 2 >= steps_.size();
  const double miss = goal ? config_.goal_miss_m : config_.step_miss_m;
  if (next.ahead_m < config_.step_accept_m || std::abs(miss_of(next)) > 2.0 * miss ||
      std::abs(next.bearing_rad) > 0.12)
    return false;
  ++step_;
  ++stats_.passed;
  tries_ = spins_ = 0;
  drive_to_ = steps_[step_];
  leg_miss_m_ = 2.0 * miss;
  leg_since_ = since_;
  return true;
}

void BrakeSteer::watch(hal::Instant now) {
  if (now - leg_since_ > config_.leg_time) return fail(SteerFault::late);
  const double speed = std::abs(estimate_.speed_m_s());
  const double rate = std::abs(estimate_.yaw_rate_rad_s());
  const bool pushes = phase_ == SteerPhase::turning || (phase_ == SteerPhase::driving && !checking_speed_);
  const hal::Pose& at = estimate_.pose();
  const bool moved = hal::distance_xy(at.position, stuck_at_.position) > kMovedM ||
                     std::abs(hal::angle_difference(at.yaw_rad, stuck_at_.yaw_rad)) > kMovedRad;
  if (!stuck_since_ || !pushes || moved) {
    stuck_since_ = now;
    stuck_at_ = at;
  }
  if (now - *stuck_since_ > config_.no_motion) return fail(SteerFault::no_motion);
  const bool locked = phase_ == SteerPhase::settling;
  if (locked && (speed > 0.08 || rate > 0.15)) {
    if (!runaway_since_) runaway_since_ = now;
    if (now - *runaway_since_ > config_.runs_away) return fail(SteerFault::runs_away);
  } else {
    runaway_since_.reset();
  }
}

// Standing again after the brakes were told to lock: how long did they take?
void BrakeSteer::learn_stop() {
  if (!stop_mark_.set) return;
  stop_mark_.set = false;
  const hal::Pose& at = estimate_.pose();
  if (side_ == Brake::none) {
    const double speed = stop_mark_.speed;
    if (speed < 0.12) return;
    const double way =
        std::hypot(at.position.x - stop_mark_.pose.position.x, at.position.y - stop_mark_.pose.position.y);
    const double lag = (way - speed * speed / (2.0 * config_.brake_m_s2)) / speed;
    learnt_.stop_lag_s = blend(learnt_.stop_lag_s, lag, 0.01, 0.6);
    return;
  }
  const double rate = stop_mark_.yaw_rate;
  if (rate < 0.15) return;
  const double sign = side_ == Brake::right ? -1.0 : 1.0;
  const double angle = sign * hal::angle_difference(at.yaw_rad, stop_mark_.pose.yaw_rad);
  const double lag = (angle - rate * rate / (2.0 * config_.turn_brake_rad_s2)) / rate;
  double& known = learnt_.turn_stop_lag_s[side_ == Brake::right ? 1 : 0];
  known = blend(known, lag, 0.01, 0.6);
}

// Slopes of speed over windows in which thrust neither came nor went.
void BrakeSteer::learn_rates(hal::Instant now) {
  constexpr hal::Duration kLong = std::chrono::milliseconds(400);
  const hal::Duration quiet = hal::from_seconds(3.0 * config_.thrust_lag_s);
  if (config_.speed_by_pitch || now - since_ < quiet) return;
  const bool turns = phase_ == SteerPhase::turning || phase_ == SteerPhase::turn_ends;
  const double sign = side_ == Brake::right ? -1.0 : 1.0;
  const double rate = turns ? sign * estimate_.yaw_rate_rad_s() : estimate_.speed_m_s();
  if (!rate_mark_.set) {
    rate_mark_ = {now, rate, 0.0, estimate_.pose(), true};
    return;
  }
  if (now - rate_mark_.at < kLong) return;
  const double slope = (rate - rate_mark_.speed) / hal::to_seconds(now - rate_mark_.at);
  const bool moving = rate > 0.1 && rate_mark_.speed > 0.1 && !checking_speed_;
  if (phase_ == SteerPhase::turning)
    learnt_.turn_push_rad_s2 = blend(learnt_.turn_push_rad_s2, slope, 0.2, 4.0);
  if (phase_ == SteerPhase::driving) learnt_.push_m_s2 = blend(learnt_.push_m_s2, slope, 0.1, 3.0);
  if (phase_ == SteerPhase::turn_ends && moving)
    learnt_.turn_coast_rad_s2 = blend(learnt_.turn_coast_rad_s2, -slope, 0.05, 3.0);
  if (phase_ == SteerPhase::coasting && moving)
    learnt_.coast_m_s2 = blend(learnt_.coast_m_s2, -slope, 0.03, 2.0);
  if (!turns && rate > 0.1) {
    const double way = std::hypot(estimate_.pose().position.x - rate_mark_.pose.position.x,
                                  estimate_.pose().position.y - rate_mark_.pose.position.y);
    const double turned = hal::angle_difference(estimate_.pose().yaw_rad, rate_mark_.pose.yaw_rad);
    if (way > 0.1) learnt_.bend_rad_m = blend(learnt_.bend_rad_m, turned / way, -0.4, 0.4);
  }
  rate_mark_ = {now, rate, 0.0, estimate_.pose(), true};
}

}  // namespace forager::servo
