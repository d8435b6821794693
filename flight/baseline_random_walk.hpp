#pragma once

#include <string_view>

#include "flight/policy.hpp"
#include "hal/random.hpp"

namespace forager::flight {

struct RandomWalkConfig {
  std::uint64_t seed = 1;
  hal::Duration window = std::chrono::seconds(2);
  double step_m = 1.0;
  double height_m = 0.0;
  hal::Duration mission_time{};  // then land
};

// Baseline: a step in a random direction, if the guard lets it.
class RandomWalk final : public Policy {
 public:
  explicit RandomWalk(const RandomWalkConfig& config) : config_(config), random_(config.seed) {}
  Step begin(const hal::Pose& pose_world) override;
  Step decide(const Observation& seen) override;
  [[nodiscard]] std::string_view name() const override { return "random_walk"; }

 private:
  RandomWalkConfig config_;
  hal::Random random_;
};

}  // namespace forager::flight
