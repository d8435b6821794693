#pragma once

#include <cstdint>
#include <optional>

#include "hal/pose.hpp"
#include "hal/random.hpp"
#include "hal/time.hpp"
#include "mocks/body.hpp"
#include "mocks/sim_autopilot_config.hpp"

namespace forager::mocks {

// What the autopilot believes, in its own frame: x, y, z of the vision source's NED, yaw clockwise from its
// x.
struct NedEstimate {
  hal::Vec3 position_m;
  hal::Vec3 velocity_m_s;
  double yaw_rad = 0.0;
};

struct VisionSample {
  hal::Vec3 position_ned_m;
  double yaw_rad = 0.0;
  std::uint8_t reset_counter = 0;
};

// How far the estimate was moved at once, for targets that must move with it.
struct EstimateShift {
  hal::Vec3 ned_m;
  double yaw_rad = 0.0;
};

// Behaves like EKF3 fed by vision only: between samples it follows the true motion (perfect inertial
// sensors), samples pull it exponentially, a changed reset counter moves it at once, and without samples a
// speed error grows in a seeded direction. Its frame is whatever the samples are in: a driver that mixes up
// axes makes this vehicle fly wrong, as the real one would.
class SimEstimator {
 public:
  SimEstimator(const SimEstimatorConfig& config, std::uint64_t seed);

  void propagate(const BodyState& truth, double dt_s, double yaw_drift_rad_s, hal::Instant now);
  // Nothing unless the sample moved the estimate at once (first sample, reset).
  std::optional<EstimateShift> fuse(const VisionSample& sample, hal::Instant now);

  [[nodiscard]] const NedEstimate& estimate() const { return estimate_; }
  [[nodiscard]] bool healthy(hal::Instant now) const { return last_ && now - *last_ <= config_.healthy; }
  // Position is known well enough to fly by.
  [[nodiscard]] bool valid(hal::Instant now) const;
  // There was a position once; it may have drifted.
  [[nodiscard]] bool started() const { return settled_; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  // Vectors between the true world (REP-103) and the estimate's NED, turned by the difference of yaws.
  [[nodiscard]] hal::Vec3 to_ned(hal::Vec3 world) const;
  [[nodiscard]] hal::Vec3 to_world(hal::Vec3 ned) const;
  [[nodiscard]] hal::Vec3 velocity_error_ned() const { return velocity_error_; }

 private:
  void turn_by(double difference_rad);

  SimEstimatorConfig config_;
  NedEstimate estimate_;
  hal::Vec3 velocity_error_;
  hal::Vec3 drift_direction_;
  double difference_rad_ = 0.0;  // estimated yaw (clockwise) plus true yaw (counter-clockwise)
  double cos_ = 1.0;
  double sin_ = 0.0;
  double true_yaw_rad_ = 0.0;
  bool settled_ = false;
  std::optional<hal::Instant> first_;  // of the present run of healthy samples
  std::optional<hal::Instant> last_;
  std::uint8_t reset_counter_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace forager::mocks
