#pragma once

#include <cstdint>
#include <optional>

#include "hal/pose_source.hpp"
#include "hal/random.hpp"
#include "hal/units.hpp"
#include "mocks/body.hpp"

namespace forager::mocks {

// Tracking camera of the T265 kind: what it gets wrong. Zeros make it perfect.
struct SimPoseOptions {
  hal::Duration period = std::chrono::microseconds(33333);
  double position_noise_m = 0.002;                // standard deviation per axis and sample
  double angle_noise_rad = hal::deg_to_rad(0.1);  // per angle and sample
  double drift_m_per_sqrt_s = 0.002;              // random walk per axis; 4 cm after 400 s
  double yaw_drift_rad_per_sqrt_s = hal::deg_to_rad(0.02);
  double dropouts_per_s = 0.0;  // tracking losses, at random
  hal::Duration dropout_length = std::chrono::milliseconds(500);
  double low_confidence_yaw_rate_rad_s = 1.5;  // turning faster smears the picture
};

enum class PoseFault : std::uint8_t {
  none,
  lost,        // samples come with confidence failed and the last pose held
  freeze,      // the pose stops changing, confidence stays high
  stall,       // no samples come and no error says so
  disconnect,  // poll() answers disconnected
};

// A localisation source that follows the true body with noise, drift, dropouts and faults. body must outlive
// it. Deterministic by seed for the same sequence of polls.
class SimPoseSource final : public hal::PoseSource {
 public:
  SimPoseSource(const TrueBody& body, const SimPoseOptions& options, std::uint64_t seed)
      : body_(&body), options_(options), random_(seed) {}

  void set_fault(PoseFault fault) { fault_ = fault; }
  // The source loses its place: every later pose is off by this much more. Announced jumps grow the reset
  // counter (the source relocalised and says so); silent ones look like motion.
  void jump(hal::Vec3 offset_world, double yaw_rad, bool announced);
  // What the estimate is off by, noise aside: drift and jumps.
  [[nodiscard]] hal::Vec3 offset_world() const { return offset_; }

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override;
  [[nodiscard]] hal::PoseSample measure(hal::Instant now, double dt_s);
  [[nodiscard]] bool dropped_out(hal::Instant now, double dt_s);

  const TrueBody* body_;
  SimPoseOptions options_;
  hal::Random random_;
  PoseFault fault_ = PoseFault::none;
  std::optional<hal::Instant> next_sample_;
  std::optional<hal::Instant> dropout_until_;
  hal::PoseSample last_;
  hal::Vec3 offset_;
  double yaw_offset_rad_ = 0.0;
  std::uint8_t resets_ = 0;
};

}  // namespace forager::mocks
