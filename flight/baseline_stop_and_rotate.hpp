#pragma once

#include <string_view>

#include "flight/policy.hpp"

namespace forager::flight {

struct StopAndRotateConfig {
  hal::Duration window = std::chrono::seconds(3);
  double speed_m_s = 0.25;
  std::uint32_t rotate_above = 10;                // new tags in a window on the way that start a rotation
  std::uint32_t rotate_below = 3;                 // new tags in a window of the rotation that end it
  double rotation_step_rad = 1.0471975511965976;  // 60 degrees a window
  std::uint32_t tries = 5;  // windows or their ways in a row without a new tag, then land
  double height_m = 0.0;
};

// Baseline of the laboratory's ground robots: go straight on; stop and rotate where many new tags are heard,
// go on when few are left. At a wall it turns to the left until the way is free.
class StopAndRotate final : public Policy {
 public:
  explicit StopAndRotate(const StopAndRotateConfig& config) : config_(config) {}
  Step begin(const hal::Pose& pose_world) override;
  Step decide(const Observation& seen) override;
  [[nodiscard]] std::string_view name() const override { return "stop_and_rotate"; }

 private:
  Step drive(double heading_rad, const hal::Pose& here) const;

  StopAndRotateConfig config_;
  bool rotating_ = false;
  std::uint32_t quiet_ = 0;  // windows or ways in a row without a new tag
  double course_rad_ = 0.0;  // to be taken up again after a rotation
};

}  // namespace forager::flight
