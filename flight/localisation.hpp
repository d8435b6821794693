#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flight/autopilot.hpp"
#include "flight/pose_history.hpp"
#include "flight/vision_filter.hpp"
#include "hal/journal.hpp"
#include "hal/pose_source.hpp"

namespace forager::flight {

// Where the body is: the localisation source through the vision filter, handed on to the autopilot's
// estimator and kept for the reads. World frame.
class Localisation {
 public:
  Localisation(hal::PoseSource& source, Autopilot& autopilot, hal::Journal& journal,
               const VisionFilterConfig& config)
      : source_(&source), autopilot_(&autopilot), journal_(&journal), own_(config), filter_(&*own_) {}
  // Borrows the filter of a vehicle on which others read the localisation at other times.
  Localisation(hal::PoseSource& source, Autopilot& autopilot, hal::Journal& journal, VisionFilter& filter)
      : source_(&source), autopilot_(&autopilot), journal_(&journal), filter_(&filter) {}
  Localisation(const Localisation&) = delete;
  Localisation& operator=(const Localisation&) = delete;

  void update(hal::Instant now);

  [[nodiscard]] bool healthy() const { return health_ == VisionHealth::good; }
  // The newest accepted pose, however old; nullopt before the first.
  [[nodiscard]] std::optional<hal::Pose> pose_world() const;
  // Since when it has not been healthy; nullopt when it is.
  [[nodiscard]] std::optional<hal::Instant> bad_since() const { return bad_since_; }
  // True once after the source has moved its world frame (a reset): goals set before mean something else now.
  [[nodiscard]] bool take_reset();
  [[nodiscard]] const PoseHistory& history() const { return history_; }
  [[nodiscard]] const VisionFilterStats& stats() const { return filter_->stats(); }

 private:
  hal::PoseSource* source_;
  Autopilot* autopilot_;
  hal::Journal* journal_;
  std::optional<VisionFilter> own_;
  VisionFilter* filter_;
  PoseHistory history_;
  VisionHealth health_ = VisionHealth::waiting;
  std::optional<hal::Instant> bad_since_;
  std::uint64_t resets_ = 0;
  bool reset_pending_ = false;
  bool source_failed_ = false;
};

}  // namespace forager::flight
