// What to do next, decided while it stands.
#include <algorithm>
#include <cmath>

#include "servo/brake_steer.hpp"

namespace forager::servo {
namespace {

constexpr double kMostAimOff = 0.12;      // rad, against a way that bends
constexpr double kTryWidening = 0.25;     // every further try is content with so much more
constexpr double kMostBack = 1.7;         // rad
constexpr double kMostHeadingTurn = 0.6;  // rad; more than this is not corrected at the goal

}  // namespace

void BrakeSteer::settle(hal::Instant now) {
  pitch_command_ = 0.0;
  if (!estimate_.known() || now - since_ < config_.settle) return;
  if (!still_since_ || now - *still_since_ < config_.settle) return;
  estimate_.stand();
  learn_stop();
  plan(now);
}

void BrakeSteer::count_try() {
  if (++tries_ > config_.most_tries) fail(SteerFault::missed);
}

void BrakeSteer::plan(hal::Instant now) {
  roll_first_ = false;
  Aim here = aim_at(steps_[step_]);
  // A step that is near enough, or just behind, is done.
  while (!last_step() && (here.distance_m < config_.step_accept_m ||
                          (here.ahead_m < 0.0 && here.distance_m < 2.0 * config_.step_accept_m))) {
    next_step(now);
    here = aim_at(steps_[step_]);
  }
  if (last_step()) {
    // Near enough; or within the margin, and to try again would make it worse.
    const bool near = here.distance_m <= config_.accept_m;
    const bool good =
        here.distance_m <= 0.7 * config_.goal_margin_m && (std::abs(here.bearing_rad) > 0.7 || tries_ > 2);
    if (near || good) return finish(now);
  }
  count_try();
  if (done()) return;

  // Its way bends: aim half the bend to the other side.
  const double off = std::clamp(-0.5 * learnt_.bend_rad_m * here.distance_m, -kMostAimOff, kMostAimOff);
  const double c = std::cos(off);
  const double s = std::sin(off);
  const Target target{c * here.ahead_m - s * here.left_m, s * here.ahead_m + c * here.left_m};
  const double miss = step_ + 2 >= steps_.size() ? config_.goal_miss_m : config_.step_miss_m;
  const double good_enough =
      std::max(config_.aim_rad, std::min(0.12, miss / std::max(0.1, here.distance_m))) *
      (1.0 + kTryWidening * (tries_ - 1));
  if (target.x_m > 0.0 && std::abs(std::atan2(target.y_m, target.x_m)) < good_enough)
    return start_drive(steps_[step_], std::max(miss, good_enough * here.distance_m), now);

  TurnConfig turn;
  turn.half_track_m = config_.half_track_m;
  const auto made = plan_turn_then_drive(target, turn);
  if (!made || made->no_way != NoWay::none) return fail(SteerFault::unreachable);
  const TurnThenDrive& way = made->chosen;
  if (way.roll_first_m > 0.02) {
    const hal::Pose& at = estimate_.pose();
    roll_first_ = true;
    return start_drive({at.position.x + way.roll_first_m * std::cos(at.yaw_rad),
                        at.position.y + way.roll_first_m * std::sin(at.yaw_rad)},
                       config_.step_miss_m, now);
  }
  if (way.brake == Brake::none) return start_drive(steps_[step_], miss, now);
  // Circling back for a step that was nearly met costs more room than it is worth, if the one after it can be
  // had more easily.
  if (!last_step() && way.turn_rad > kMostBack) {
    const Aim after = aim_at(steps_[step_ + 1]);
    const auto other = plan_turn_then_drive({after.ahead_m, after.left_m}, turn);
    if (other && other->no_way == NoWay::none && other->chosen.turn_rad < kMostBack) return next_step(now);
  }
  if (last_step() && way.turn_rad > kMostBack && here.distance_m < config_.goal_margin_m) return finish(now);
  to_heading_ = false;
  start_turn(way.brake, way.turn_rad, now);
}

void BrakeSteer::next_step(hal::Instant now) {
  ++step_;
  tries_ = 0;
  leg_since_ = now;
}

// At the goal's place; its heading may still be put right, as long as that does not cost the place.
void BrakeSteer::finish(hal::Instant now) {
  const Aim here = aim_at(steps_[step_]);
  const double off =
      goal_heading_rad_ ? hal::angle_difference(*goal_heading_rad_, estimate_.pose().yaw_rad) : 0.0;
  if (std::abs(off) > config_.accept_heading_rad && std::abs(off) < kMostHeadingTurn &&
      tries_ <= config_.most_tries) {
    // Turning by `off` about either wheel carries the middle forward by r |off|.
    const double moved = std::hypot(here.ahead_m - config_.half_track_m * std::abs(off), here.left_m);
    if (moved < 0.85 * config_.goal_margin_m) {
      count_try();
      to_heading_ = true;
      return start_turn(off > 0.0 ? Brake::left : Brake::right, std::abs(off), now);
    }
  }
  const bool there = here.distance_m <= config_.goal_margin_m && std::abs(off) <= config_.heading_margin_rad;
  if (there) return enter(SteerPhase::arrived, now);
  fail(SteerFault::missed);
}

void BrakeSteer::start_turn(Brake side, double angle_rad, hal::Instant now) {
  side_ = side;
  turn_left_ = angle_rad;
  checking_speed_ = false;
  ++stats_.turns;
  stop_mark_.set = false;
  enter(SteerPhase::turning, now);
}

void BrakeSteer::start_drive(const SteerStep& to, double miss_m, hal::Instant now) {
  drive_to_ = to;
  leg_miss_m_ = miss_m;
  side_ = Brake::none;
  checking_speed_ = dab_open_ = false;
  dab_ = Brake::none;
  dab_judged_ = now;
  ++stats_.drives;
  stop_mark_.set = false;
  enter(SteerPhase::releasing, now);
}

}  // namespace forager::servo
