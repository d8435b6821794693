#pragma once

#include <string_view>

#include "flight/policy.hpp"

namespace forager::flight {

struct StaticConfig {
  hal::Duration mission_time{};  // hover this long, then land
  hal::Duration window = std::chrono::seconds(2);
  double height_m = 0.0;
};

// Baseline: hovers where it started (experiments 1A, 2A, 3A).
class Static final : public Policy {
 public:
  explicit Static(const StaticConfig& config) : config_(config) {}
  Step begin(const hal::Pose& pose_world) override;
  Step decide(const Observation& seen) override;
  [[nodiscard]] std::string_view name() const override { return "static"; }

 private:
  StaticConfig config_;
  double heading_rad_ = 0.0;
};

}  // namespace forager::flight
