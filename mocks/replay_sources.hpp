#pragma once

#include <string>
#include <vector>

#include "hal/depth_source.hpp"
#include "hal/pose_source.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// What mocks/recording_sources.hpp noted, with stamps moved to the time of the replay; `name` as it was given
// there.

class ReplayPoseSource final : public hal::PoseSource {
 public:
  ReplayPoseSource(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<std::optional<hal::PoseSample>> do_poll(hal::Instant now) override;
  std::string name_;
  Replay* replay_;
};

class ReplayDepthSource final : public hal::DepthSource {
 public:
  ReplayDepthSource(std::string name, Replay& replay) : name_(std::move(name)), replay_(&replay) {}

 private:
  hal::Result<std::optional<hal::DepthFrame>> do_poll(hal::Instant now) override;
  std::string name_;
  Replay* replay_;
  std::vector<std::uint16_t> millimetres_;
  std::vector<float> metres_;
};

}  // namespace forager::mocks
