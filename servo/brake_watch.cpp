#include "servo/brake_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace forager::servo {
namespace {

constexpr double kLocked = 0.95;
constexpr double kOpen = 0.05;

}  // namespace

std::string_view to_string(BrakeSide side) { return side == BrakeSide::left ? "left" : "right"; }

std::string_view to_string(BrakeFaultKind kind) {
  switch (kind) {
    case BrakeFaultKind::none:
      return "none";
    case BrakeFaultKind::output:
      return "output";
    case BrakeFaultKind::mismatch:
      return "mismatch";
    case BrakeFaultKind::slip:
      return "slip";
    case BrakeFaultKind::drag:
      return "drag";
  }
  return "unknown";
}

void BrakeWatch::saw(double commanded, std::optional<double> measured, hal::Instant now) {
  if (std::abs(commanded - settled_on_) > kOpen) {
    settled_on_ = commanded;
    changed_ = now;
    suspected_ = BrakeFaultKind::none;
  }
  commanded_ = commanded;
  measured_ = measured;
}

void BrakeWatch::reset(hal::Instant now) {
  changed_ = now;
  suspected_ = BrakeFaultKind::none;
}

BrakeFaultKind BrakeWatch::suspicion(const std::optional<VehicleMotion>& motion, double other_commanded,
                                     hal::Instant now) {
  if (now - changed_ < config_.settle) return BrakeFaultKind::none;
  if (measured_ && !(std::abs(*measured_ - commanded_) <= config_.measured_tolerance))
    return BrakeFaultKind::mismatch;
  if (!motion || motion->at > now || now - motion->at > config_.motion_max_age) return BrakeFaultKind::none;
  const double left_m_s = motion->forward_m_s - motion->yaw_rate_rad_s * config_.half_track_m;
  const double right_m_s = motion->forward_m_s + motion->yaw_rate_rad_s * config_.half_track_m;
  if (!std::isfinite(left_m_s) || !std::isfinite(right_m_s)) return BrakeFaultKind::none;
  wheel_m_s_ = side_ == BrakeSide::left ? left_m_s : right_m_s;
  other_wheel_m_s_ = side_ == BrakeSide::left ? right_m_s : left_m_s;
  if (commanded_ >= kLocked && std::abs(wheel_m_s_) > config_.slip_m_s) return BrakeFaultKind::slip;
  if (commanded_ <= kOpen && other_commanded <= kOpen && std::abs(wheel_m_s_) < config_.standing_m_s &&
      std::abs(other_wheel_m_s_) > config_.turning_m_s)
    return BrakeFaultKind::drag;
  return BrakeFaultKind::none;
}

BrakeFaultKind BrakeWatch::judge(const std::optional<VehicleMotion>& motion, double other_commanded,
                                 hal::Instant now) {
  const BrakeFaultKind seen = suspicion(motion, other_commanded, now);
  if (seen != suspected_) {
    suspected_ = seen;
    suspected_since_ = now;
  }
  return seen != BrakeFaultKind::none && now - suspected_since_ >= config_.confirm ? seen
                                                                                   : BrakeFaultKind::none;
}

std::string BrakeWatch::detail(BrakeFaultKind kind) const {
  switch (kind) {
    case BrakeFaultKind::mismatch:
      return fmt::format("told {:.2f} and measures {:.2f}", commanded_, measured_.value_or(0.0));
    case BrakeFaultKind::slip:
      return fmt::format("locked, and the wheel moves at {:.2f} m/s", wheel_m_s_);
    case BrakeFaultKind::drag:
      return fmt::format("open, and the wheel stands while the other one moves at {:.2f} m/s",
                         other_wheel_m_s_);
    case BrakeFaultKind::none:
    case BrakeFaultKind::output:
      break;
  }
  return {};
}

bool BrakeHeatModel::update(double fraction, hal::Instant now) {
  const double passed_s = last_ ? std::max(0.0, hal::to_seconds(now - *last_)) : 0.0;
  last_ = now;
  const double goal_k = fraction * fraction * config_.hold_rise_k;
  heat_.rise_k += (goal_k - heat_.rise_k) * -std::expm1(-passed_s / config_.time_constant_s);
  if (heat_.rise_k > config_.warn_rise_k) heat_.hot_s += passed_s;
  heat_.locked_s = fraction >= kLocked ? heat_.locked_s + passed_s : 0.0;
  const bool advised =
      heat_.rise_k > config_.warn_rise_k || heat_.locked_s > hal::to_seconds(config_.max_locked);
  return std::exchange(heat_.rest_advised, advised) != advised;
}

}  // namespace forager::servo
