#pragma once

#include <cstdint>
#include <optional>

#include "hal/pose.hpp"
#include "hal/pose_source.hpp"
#include "hal/time.hpp"

namespace forager::flight {

struct VisionFilterConfig {
  hal::Pose camera_on_body;  // mounting; identity when the source already delivers the body's pose
  hal::Duration min_interval = std::chrono::milliseconds(33);  // between samples passed on
  // A sample is a jump when it is further from the one before than the vehicle can have gone:
  // speed x time + margin, and the same for yaw.
  double max_speed_m_s = 2.0;
  double jump_margin_m = 0.1;  // noise of the source; above 0.1 m between frames is the usual alarm
  double max_yaw_rate_rad_s = 2.0;
  double yaw_margin_rad = 0.15;
  // A jump that agrees with itself for both of these is where the source now believes to be: a reset.
  int reset_after_samples = 10;
  hal::Duration reset_after = std::chrono::milliseconds(300);
  hal::Duration stale_after = std::chrono::milliseconds(300);  // ArduPilot calls vision unhealthy then
  // A stamp further ahead of now than this is a broken clock. Believed, it would make every later sample "not
  // newer" and itself fresh for as long as it lies ahead.
  hal::Duration most_ahead = std::chrono::milliseconds(50);
  hal::PoseConfidence min_confidence = hal::PoseConfidence::low;
};

enum class VisionHealth : std::uint8_t {
  waiting,  // no usable sample has ever come
  good,
  stale,           // the source has fallen silent
  low_confidence,  // it speaks, but does not trust itself
  jumping,         // it speaks, but not of where the vehicle can be
};

struct VisionFilterStats {
  std::uint64_t passed = 0;
  std::uint64_t thinned = 0;         // good, but sooner than min_interval
  std::uint64_t jumps = 0;           // dropped as jumps
  std::uint64_t low_confidence = 0;  // dropped for it
  std::uint64_t unusable = 0;        // not finite, not newer than the one before, or of the future
  std::uint64_t resets = 0;
};

// Between a localisation source and the autopilot's estimator. A jump that reached the estimator unmarked
// would move the vehicle; dropped for ever it would leave the estimator blind. So a jump is dropped and
// counted until it has persisted, and then passed on with a new reset counter, upon which the estimator steps
// to it instead of flying after it. A source that itself reports a reset is believed at once.
class VisionFilter {
 public:
  explicit VisionFilter(const VisionFilterConfig& config);

  // The body's sample to hand to the autopilot, or nullopt. Its reset_counter is ours, from 0.
  [[nodiscard]] std::optional<hal::PoseSample> update(const hal::PoseSample& sample, hal::Instant now);

  [[nodiscard]] VisionHealth health(hal::Instant now) const;
  // The newest accepted sample, thinned or not: the best estimate of the body's pose.
  [[nodiscard]] const std::optional<hal::PoseSample>& newest() const { return accepted_; }
  [[nodiscard]] const VisionFilterStats& stats() const { return stats_; }

 private:
  // How far apart two poses are, in margins.
  [[nodiscard]] double gap(const hal::Pose& a, const hal::Pose& b) const;
  [[nodiscard]] bool reachable(const hal::PoseSample& from, const hal::PoseSample& to) const;
  bool is_jump(const hal::PoseSample& sample);
  void count_reset();

  VisionFilterConfig config_;
  bool has_mount_;
  std::optional<hal::PoseSample> accepted_;
  std::optional<hal::PoseSample> jumped_;  // the newest of a run of jumps that agree with each other
  hal::Instant jump_began_{};
  int jump_samples_ = 0;
  std::optional<hal::Instant> last_passed_;
  std::optional<hal::Instant> last_seen_;
  VisionHealth last_verdict_ = VisionHealth::waiting;
  std::uint8_t source_counter_ = 0;
  std::uint8_t reset_counter_ = 0;
  VisionFilterStats stats_;
};

}  // namespace forager::flight
