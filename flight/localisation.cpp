#include "flight/localisation.hpp"

namespace forager::flight {
namespace {

constexpr std::string_view kSource = "localisation";

std::string_view text_of(VisionHealth health) {
  switch (health) {
    case VisionHealth::waiting:
      return "no pose yet";
    case VisionHealth::good:
      return "good";
    case VisionHealth::stale:
      return "no pose arrives";
    case VisionHealth::low_confidence:
      return "the source does not trust itself";
    case VisionHealth::jumping:
      return "the poses jump";
  }
  return "?";
}

}  // namespace

void Localisation::update(hal::Instant now) {
  auto sample = source_->poll(now);
  if (!sample) {
    if (!source_failed_) journal_->note(now, kSource, hal::describe(sample.error()));
    source_failed_ = true;
  } else {
    source_failed_ = false;
    if (*sample) {
      if (const auto passed = filter_->update(**sample, now)) autopilot_->send_vision(*passed);
      if (filter_->stats().resets != resets_) {
        resets_ = filter_->stats().resets;
        history_.clear();
        reset_pending_ = true;
        journal_->note(now, kSource, "the source moved its world frame");
      }
      if (const auto& newest = filter_->newest()) history_.add(newest->stamp, newest->pose);
    }
  }
  const VisionHealth health = filter_->health(now);
  if (health != health_) journal_->note(now, kSource, text_of(health));
  health_ = health;
  if (healthy())
    bad_since_.reset();
  else if (!bad_since_)
    bad_since_ = now;
}

std::optional<hal::Pose> Localisation::pose_world() const {
  if (!filter_->newest()) return std::nullopt;
  return filter_->newest()->pose;
}

bool Localisation::take_reset() {
  const bool pending = reset_pending_;
  reset_pending_ = false;
  return pending;
}

}  // namespace forager::flight
