#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "flight/policy.hpp"

namespace forager::flight {

struct DeadReckoningConfig {
  std::vector<hal::Vec3> waypoints_world;  // x and y count; flown in order
  double height_m = 0.0;
  double speed_m_s = 0.25;
  double reached_m = 0.3;
  std::uint32_t patience = 5;  // looks in a row at a blocked way before the waypoint is given up
  hal::Duration wait = std::chrono::seconds(2);  // between them
};

// Baseline: a fixed path, reading on the way; navigation and reader know nothing of each other (experiments
// 1B, 2B, 3B). The guard still stops it.
class DeadReckoning final : public Policy {
 public:
  explicit DeadReckoning(DeadReckoningConfig config) : config_(std::move(config)) {}
  Step begin(const hal::Pose& pose_world) override;
  Step decide(const Observation& seen) override;
  [[nodiscard]] std::string_view name() const override { return "dead_reckoning"; }

 private:
  DeadReckoningConfig config_;
  std::size_t next_ = 0;
  std::uint32_t blocked_looks_ = 0;
  bool waiting_ = false;  // before a blocked way
};

}  // namespace forager::flight
