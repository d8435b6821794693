#pragma once

#include <cstdint>
#include <optional>

#include "hal/pose.hpp"
#include "hal/pose_source.hpp"
#include "hal/time.hpp"

namespace forager::servo {

struct MotionEstimateConfig {
  double position_noise_m = 0.006;      // standard deviation of one pose sample, per axis
  double yaw_noise_rad = 0.008;         // of one pose sample
  double yaw_rate_noise_rad_s = 0.02;   // of one gyro reading
  double accel_noise_m_s2 = 0.8;        // how far the expected acceleration may be off
  double yaw_accel_noise_rad_s2 = 3.0;  // brakes bite hard
  hal::Duration longest_step = std::chrono::milliseconds(100);  // of one prediction
  hal::Duration most_ahead = std::chrono::milliseconds(50);     // a stamp further in the future is wrong
};

// Where a rolling vehicle is and how it moves between and through 30 Hz poses: position and forward speed
// along the heading, heading and yaw rate, each pair a Kalman filter with white acceleration noise. A pose
// that arrives late is compared with where the vehicle was at its stamp. World frame, REP-103. No allocation.
class MotionEstimate {
 public:
  explicit MotionEstimate(const MotionEstimateConfig& config) : config_(config) {}

  // Carries the estimate to `now` with the accelerations the caller expects.
  void predict(hal::Instant now, double accel_m_s2, double yaw_accel_rad_s2);
  // A new pose. One that is not finite, that its source does not trust at all, that is not newer than the one
  // before, or that lies in the future of the newest predict(), is not taken: false. A reset counter that
  // changed starts the position anew.
  bool take(const hal::PoseSample& sample);
  void take_yaw_rate(double rate_rad_s);
  // Both wheels have been locked long enough: it stands.
  void stand();

  [[nodiscard]] bool known() const { return last_pose_.has_value(); }
  [[nodiscard]] const hal::Pose& pose() const { return pose_; }
  [[nodiscard]] double speed_m_s() const { return speed_; }  // forward
  [[nodiscard]] double yaw_rate_rad_s() const { return yaw_rate_; }
  // Longest: never seen, or seen at a time that has not come yet.
  [[nodiscard]] hal::Duration pose_age(hal::Instant now) const {
    return last_pose_ && *last_pose_ - now <= config_.most_ahead ? now - *last_pose_ : hal::Duration::max();
  }
  // Grows when the source moved its frame: goals of before mean something else now.
  [[nodiscard]] std::uint32_t resets() const { return resets_; }

 private:
  // Covariance of a value and its rate.
  struct Covariance {
    double value = 0.0;
    double cross = 0.0;
    double rate = 0.0;
    void grow(double dt, double noise);
    void measure_value(double gain_value, double gain_rate);
  };
  void start(const hal::PoseSample& sample);

  MotionEstimateConfig config_;
  hal::Pose pose_;
  double speed_ = 0.0;
  double yaw_rate_ = 0.0;
  Covariance along_;
  Covariance turn_;
  std::optional<hal::Instant> last_pose_;  // stamp of the newest sample taken
  hal::Instant now_;
  bool predicted_ = false;  // now_ is known
  std::uint8_t reset_counter_ = 0;
  std::uint32_t resets_ = 0;
};

}  // namespace forager::servo
