#include "flight/vision_filter.hpp"

#include <algorithm>
#include <cmath>

#include "flight/frames.hpp"
#include "hal/units.hpp"

namespace forager::flight {
namespace {

bool is_finite(const hal::Pose& pose) {
  return hal::is_finite(pose.position) &&
         hal::is_finite(hal::Vec3{pose.yaw_rad, pose.pitch_rad, pose.roll_rad});
}

bool is_identity(const hal::Pose& pose) {
  return pose.position == hal::Vec3{} && pose.yaw_rad == 0.0 && pose.pitch_rad == 0.0 && pose.roll_rad == 0.0;
}

}  // namespace

VisionFilter::VisionFilter(const VisionFilterConfig& config)
    : config_(config), has_mount_(!is_identity(config.camera_on_body)) {}

std::optional<hal::PoseSample> VisionFilter::update(const hal::PoseSample& raw, hal::Instant now) {
  const bool in_order = (!last_seen_ || raw.stamp > *last_seen_) && raw.stamp - now <= config_.most_ahead;
  if (!is_finite(raw.pose) || !in_order) {
    ++stats_.unusable;
    return std::nullopt;
  }
  last_seen_ = raw.stamp;
  if (raw.confidence < config_.min_confidence) {
    ++stats_.low_confidence;
    last_verdict_ = VisionHealth::low_confidence;
    return std::nullopt;
  }
  hal::PoseSample sample = raw;
  if (has_mount_) sample.pose = take_out_mount(raw.pose, config_.camera_on_body);

  if (accepted_ && raw.reset_counter != source_counter_)
    count_reset();
  else if (accepted_ && is_jump(sample))
    return std::nullopt;
  source_counter_ = raw.reset_counter;
  sample.reset_counter = reset_counter_;
  accepted_ = sample;
  last_verdict_ = VisionHealth::good;

  if (last_passed_ && sample.stamp - *last_passed_ < config_.min_interval) {
    ++stats_.thinned;
    return std::nullopt;
  }
  last_passed_ = sample.stamp;
  ++stats_.passed;
  return sample;
}

// While jumps go on, a sample belongs to whichever is nearer: the place before or the place jumped to. What
// the vehicle could have reached meanwhile says nothing: it grows with every dropped sample.
bool VisionFilter::is_jump(const hal::PoseSample& sample) {
  const bool goes_on = jumped_ && reachable(*jumped_, sample) &&
                       gap(jumped_->pose, sample.pose) <= gap(accepted_->pose, sample.pose);
  if (!goes_on && reachable(*accepted_, sample)) {
    jumped_.reset();
    return false;
  }
  if (!goes_on) {
    jump_began_ = sample.stamp;
    jump_samples_ = 0;
  }
  jumped_ = sample;
  ++jump_samples_;
  if (jump_samples_ >= config_.reset_after_samples && sample.stamp - jump_began_ >= config_.reset_after) {
    count_reset();
    return false;
  }
  ++stats_.jumps;
  last_verdict_ = VisionHealth::jumping;
  return true;
}

void VisionFilter::count_reset() {
  jumped_.reset();
  ++reset_counter_;
  ++stats_.resets;
}

double VisionFilter::gap(const hal::Pose& a, const hal::Pose& b) const {
  return std::max(hal::norm(b.position - a.position) / config_.jump_margin_m,
                  std::abs(hal::angle_difference(b.yaw_rad, a.yaw_rad)) / config_.yaw_margin_rad);
}

bool VisionFilter::reachable(const hal::PoseSample& from, const hal::PoseSample& to) const {
  // After a long silence the autopilot has gone on by itself; a free ride of speed x silence would be a jump.
  const double dt_s = hal::to_seconds(std::min(to.stamp - from.stamp, config_.stale_after));
  const double moved_m = hal::norm(to.pose.position - from.pose.position);
  const double turned_rad = std::abs(hal::angle_difference(to.pose.yaw_rad, from.pose.yaw_rad));
  return moved_m <= config_.max_speed_m_s * dt_s + config_.jump_margin_m &&
         turned_rad <= config_.max_yaw_rate_rad_s * dt_s + config_.yaw_margin_rad;
}

VisionHealth VisionFilter::health(hal::Instant now) const {
  if (!accepted_) return last_seen_ ? last_verdict_ : VisionHealth::waiting;
  if (now - accepted_->stamp < config_.stale_after) return VisionHealth::good;
  return now - *last_seen_ < config_.stale_after ? last_verdict_ : VisionHealth::stale;
}

}  // namespace forager::flight
