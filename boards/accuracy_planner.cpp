#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "boards/accuracy_row.hpp"
#include "boards/planner_truth.hpp"
#include "boards/published_turn.hpp"

// Where turn-then-drive plans end, for r = 0.5 m (the printed constants hold for no other), and what they
// cost. An answer fails when it is no number or ends more than 1 mm from the target.
namespace forager::boards {
namespace {

constexpr double kHalfTrackM = 0.5;
constexpr double kFailsFromM = 1e-3;

using Targets = std::vector<servo::Target>;
using Turn = PublishedTurn;  // one turn, one drive

PlanValues values_of(const Turn& turn) {
  return {Wide(0.0), Wide(turn.left ? turn.turn_rad : -turn.turn_rad), Wide(turn.drive_m)};
}

double end_error_m(const Turn& turn, servo::Target target) {
  if (!std::isfinite(turn.turn_rad) || !std::isfinite(turn.drive_m)) return NAN;
  const WidePoint end = end_of(values_of(turn), turn.left ? kHalfTrackM : -kHalfTrackM);
  return std::hypot((end.x - Wide(target.x_m)).rounded(), (end.y - Wide(target.y_m)).rounded());
}

// The closed form with nothing done about rounding; the shorter of both turns.
template <class T, class TurnAbout>
Turn shorter(servo::Target target, TurnAbout turn_about) {
  const T x = static_cast<T>(target.x_m);
  const T full = static_cast<T>(2.0 * hal::kPi);
  Turn best{.turn_rad = INFINITY};
  for (const bool left : {true, false}) {
    const T y = static_cast<T>(left ? target.y_m : -target.y_m);
    const T q = x * x + y * (y - static_cast<T>(2.0 * kHalfTrackM));
    if (q < T(0)) continue;
    const T drive = std::sqrt(q);
    T turn = std::fmod(turn_about(x, y, drive), full);
    if (turn < T(0)) turn += full;
    if (static_cast<double>(turn) < best.turn_rad)
      best = {left, static_cast<double>(turn), static_cast<double>(drive)};
  }
  return best;
}

template <class T>
Turn two_arctangents(servo::Target target) {
  const T r = static_cast<T>(kHalfTrackM);
  return shorter<T>(target, [r](T x, T y, T d) { return std::atan2(y - r, x) + std::atan2(r, d); });
}

Turn half_angle_f32(servo::Target target) {
  constexpr auto kTrack = static_cast<float>(2.0 * kHalfTrackM);
  return shorter<float>(target, [](float x, float y, float d) {
    return 2.0F * (x >= 0.0F ? std::atan2(y, x + d) : std::atan2(d - x, y - kTrack));
  });
}

Turn as_printed(servo::Target target) { return published_turn(target, Reading::as_printed); }
Turn mended(servo::Target target) { return published_turn(target, Reading::mended); }

servo::TurnThenDrive planned(servo::Target target) {
  const auto plan = servo::plan_turn_then_drive(target, {.half_track_m = kHalfTrackM});
  return plan ? plan->chosen : servo::TurnThenDrive{};
}

template <class Solve, class Error>
AccuracyRow row(const std::string& name, std::string variant, const std::shared_ptr<Targets>& targets,
                std::size_t timed, Solve solve, Error error_m) {
  AccuracyRow out{.name = name, .variant = std::move(variant), .reference = "the movements to 100 bits"};
  for (const servo::Target target : *targets) {
    const double error = error_m(solve(target), target);
    ++out.asked;
    if (!(error <= kFailsFromM)) ++out.failures;
    if (!std::isfinite(error)) continue;
    out.max_abs_error = std::max(out.max_abs_error, error);
    out.max_rel_error = std::max(out.max_rel_error, error / distance_m(target));
  }
  const auto sink = std::make_shared<double>(0.0);
  out.items = static_cast<double>(std::min(timed, targets->size()));
  out.work = [targets, timed, solve, sink] {
    for (std::size_t i = 0; i < std::min(timed, targets->size()); ++i) *sink += solve((*targets)[i]).drive_m;
  };
  return out;
}

void add_rows(std::vector<AccuracyRow>& rows, const std::string& name,
              const std::shared_ptr<Targets>& targets) {
  constexpr std::size_t kTimed = 4096;
  const auto with_rests = [](const servo::TurnThenDrive& way, servo::Target target) {
    return miss_m(way, kHalfTrackM, target, Rests::with);
  };
  const auto alone = [](const servo::TurnThenDrive& way, servo::Target target) {
    return miss_m(way, kHalfTrackM, target, Rests::without);
  };
  rows.push_back(row(name, "closed form, f64 with rests", targets, kTimed, planned, with_rests));
  rows.push_back(row(name, "closed form, f64", targets, kTimed, planned, alone));
  rows.push_back(row(name, "closed form, f32", targets, kTimed, half_angle_f32, end_error_m));
  rows.push_back(row(name, "two arctangents, f64", targets, kTimed, two_arctangents<double>, end_error_m));
  rows.push_back(row(name, "two arctangents, f32", targets, kTimed, two_arctangents<float>, end_error_m));
  rows.push_back(row(name, "as published (6.5-6.10), f64", targets, kTimed, as_printed, end_error_m));
  rows.push_back(row(name, "6.5, 6.7 and 6.10 mended, f64", targets, kTimed, mended, end_error_m));
}

}  // namespace

std::vector<AccuracyRow> accuracy_planner(const AccuracyOptions& options) {
  const auto count = static_cast<unsigned>(std::max(400.0, 200'000.0 * options.effort));
  const auto everyday = std::make_shared<Targets>();
  const auto hard = std::make_shared<Targets>();
  hal::Random random(options.seed);
  for (unsigned i = 0; i < count; ++i) {
    everyday->push_back(hard_target(random, 0, kHalfTrackM));
    hard->push_back(hard_target(random, 1 + i % 3, kHalfTrackM));
  }
  std::vector<AccuracyRow> rows;
  add_rows(rows, "turn-then-drive: end, metres, targets within 10 m", everyday);
  add_rows(rows, "turn-then-drive: end, metres, hard targets 1e-12 to 1e6 m", hard);
  return rows;
}

}  // namespace forager::boards
