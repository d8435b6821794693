#include "servo/turn_then_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "servo/double_pair.hpp"

namespace forager::servo {
namespace {

constexpr DoublePair kFullTurn{6.283185307179586, 2.4492935982947064e-16};  // 2 pi
constexpr double kSmallSlope = 0.125;

// x - atan(x) for 0 <= x < kSmallSlope, relative error below 1e-14.
double arc_deficit(double x) {
  const double s = x * x;
  constexpr double kTerms[] = {1.0 / 17, -1.0 / 15, 1.0 / 13, -1.0 / 11,
                               1.0 / 9,  -1.0 / 7,  1.0 / 5,  -1.0 / 3};
  double sum = 0.0;
  for (const double term : kTerms) sum = sum * s + term;
  return -sum * s * x;
}

// 2 atan2(rise, run), both >= 0. Small angles keep their rest: they are subtracted from a full turn.
DoublePair twice_the_angle(DoublePair rise, DoublePair run) {
  if (rise.high >= kSmallSlope * run.high) return {2.0 * std::atan2(rise.high, run.high), 0.0};
  const DoublePair slope = rise / run;
  const DoublePair angle = slope + -arc_deficit(slope.high);
  return {2.0 * angle.high, 2.0 * angle.low};
}

DoublePair short_of_full_turn(DoublePair angle) {
  const DoublePair left = exact_sum(kFullTurn.high, -angle.high);
  return exact_sum(left.high, left.low + (kFullTurn.low - angle.low));
}

// x^2 + y (y - 2r), exact but for the last of about 150 bits: near the circle the two parts cancel.
DoublePair squared_drive(double x, double y, DoublePair y_minus_2r) {
  const DoublePair forward = exact_product(x, x);
  const DoublePair across = exact_product(y, y_minus_2r.high);
  const DoublePair across_rest = exact_product(y, y_minus_2r.low);
  const DoublePair high = exact_sum(forward.high, across.high);
  const DoublePair middle = exact_sum(forward.low, across.low);
  const DoublePair low = exact_sum(middle.high, across_rest.high);
  const DoublePair q = exact_sum(high.high, low.high);
  return exact_sum(q.high, q.low + (high.low + (middle.low + low.low + across_rest.low)));
}

struct Way {
  DoublePair roll_first, turn, drive;
  bool inside_circle = false;
};

// The turn of a target that is not inside the circle. No branch subtracts what nearly cancels: tan(Delta/2)
// is y / (x + D) = (D - x) / (y - 2r).
DoublePair turn_to(double x, double y, DoublePair y_minus_2r, DoublePair drive) {
  if (x >= 0.0 && y >= 0.0) return twice_the_angle({y, 0.0}, drive + x);
  if (x >= 0.0) return short_of_full_turn(twice_the_angle({-y, 0.0}, drive + x));
  if (y_minus_2r.high > 0.0) return twice_the_angle(drive + -x, y_minus_2r);
  return short_of_full_turn(twice_the_angle(drive + -x, -y_minus_2r));
}

// Left brake; x and y not both zero, both of a size whose squares are neither infinite nor denormal.
Way about_left_wheel(double x, double y, double r) {
  const DoublePair y_minus_2r = exact_sum(y, -2.0 * r);
  const DoublePair q = squared_drive(x, y, y_minus_2r);
  Way way;
  if (q.high >= 0.0) {
    way.drive = root(q);
    way.turn = turn_to(x, y, y_minus_2r, way.drive);
    return way;
  }
  // Rolling on until the target lies on the circle, behind: then the turn alone ends on it.
  way.inside_circle = true;
  const DoublePair behind = root(-squared_drive(0.0, y, y_minus_2r));
  way.roll_first = x >= 0.0 ? behind + x : -q / (behind + -x);
  way.turn = short_of_full_turn(twice_the_angle(behind, -y_minus_2r));
  return way;
}

bool straight_ahead(Target target, double band) {
  // fma: the exact sign, so that the promised bound is not missed by a rounding.
  return target.x_m > 0.0 && std::fma(-band, target.x_m, std::abs(target.y_m)) <= 0.0;
}

// Where squares would overflow or lose bits the whole geometry is scaled by a power of two.
int scale_exponent(Target target) {
  const int exponent = std::ilogb(std::max(std::abs(target.x_m), std::abs(target.y_m)));
  return std::abs(exponent) < 400 ? 0 : std::clamp(-exponent, -1000, 1000);
}

TurnThenDrive way_about(Brake brake, Target target, const TurnConfig& config) {
  TurnThenDrive out;
  out.brake = brake;
  const int scale = scale_exponent(target);
  const double mirror = brake == Brake::right ? -1.0 : 1.0;
  const auto scaled = [](double value, int by) { return by == 0 ? value : std::ldexp(value, by); };
  const Way way = about_left_wheel(scaled(target.x_m, scale), scaled(mirror * target.y_m, scale),
                                   scaled(config.half_track_m, scale));
  out.inside_circle = way.inside_circle;
  out.roll_first_m = scaled(way.roll_first.high, -scale);
  out.turn_rad = way.turn.high;
  out.drive_m = scaled(way.drive.high, -scale);
  out.rest = {scaled(way.roll_first.low, -scale), way.turn.low, scaled(way.drive.low, -scale)};
  return out;
}

void choose(TurnPlan& plan, const TurnConfig& config) {
  if (!config.left_brake && !config.right_brake) {
    plan.no_way = NoWay::no_brake;
    return;
  }
  const auto better = [&](const TurnThenDrive& a, const TurnThenDrive& b) {
    if (config.roll_first != RollFirst::if_shorter_turn && a.inside_circle != b.inside_circle)
      return b.inside_circle;
    return a.turn_rad <= b.turn_rad;
  };
  const bool left = config.left_brake && (!config.right_brake || better(plan.left, plan.right));
  plan.chosen = left ? plan.left : plan.right;
  if (plan.chosen.inside_circle && config.roll_first == RollFirst::never)
    plan.no_way = NoWay::inside_circle;
  else if (plan.chosen.turn_rad > config.max_turn_rad)
    plan.no_way = NoWay::turn_too_large;
  else if (!std::isfinite(plan.chosen.drive_m) || !std::isfinite(plan.chosen.roll_first_m))
    plan.no_way = NoWay::too_far;
}

// The entry of the input that can never work; empty if all can.
std::string complaint(Target target, const TurnConfig& config) {
  if (!std::isfinite(target.x_m) || !std::isfinite(target.y_m))
    return fmt::format("target ({}, {}) is not finite", target.x_m, target.y_m);
  if (!(config.half_track_m >= 1e-3 && config.half_track_m <= 1e3))
    return fmt::format("half track {} m is not within 0.001 .. 1000", config.half_track_m);
  if (!(config.straight_band >= 0.0 && config.straight_band <= 1.0))
    return fmt::format("straight band {} is not within 0 .. 1", config.straight_band);
  if (!(config.max_turn_rad >= 0.0 && config.max_turn_rad <= 2.0 * hal::kPi))
    return fmt::format("largest turn {} rad is not within 0 .. 2 pi", config.max_turn_rad);
  return {};
}

}  // namespace

std::string_view to_string(Brake brake) {
  switch (brake) {
    case Brake::none:
      return "none";
    case Brake::left:
      return "left";
    case Brake::right:
      return "right";
  }
  return "?";
}

std::string_view to_string(NoWay reason) {
  switch (reason) {
    case NoWay::none:
      return "none";
    case NoWay::no_brake:
      return "no brake to turn with";
    case NoWay::inside_circle:
      return "inside the pivot circle";
    case NoWay::turn_too_large:
      return "turn too large";
    case NoWay::too_far:
      return "too far";
  }
  return "?";
}

hal::Result<TurnPlan> plan_turn_then_drive(Target target, const TurnConfig& config) {
  if (std::string wrong = complaint(target, config); !wrong.empty())
    return hal::fail(hal::ErrorCode::invalid_argument, "turn-then-drive planner", "plan", std::move(wrong));
  TurnPlan plan;
  plan.left.brake = Brake::left;
  plan.right.brake = Brake::right;
  if (target.x_m == 0.0 && target.y_m == 0.0) return plan;
  if (straight_ahead(target, config.straight_band)) {
    plan.left.drive_m = plan.right.drive_m = plan.chosen.drive_m = target.x_m;
    return plan;
  }
  plan.left = way_about(Brake::left, target, config);
  plan.right = way_about(Brake::right, target, config);
  choose(plan, config);
  return plan;
}

}  // namespace forager::servo
