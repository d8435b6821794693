#include "flight/read_intake.hpp"

#include <algorithm>
#include <chrono>

namespace forager::flight {
namespace {

// A read may be newer than the newest pose: the camera's frame is still on its way.
constexpr hal::Duration kPoseSlack = std::chrono::milliseconds(250);

}  // namespace

ReadIntake::ReadIntake(std::span<const reader::ReadPort> ports, reader::ShareRule rule,
                       std::size_t expected_tags, InventorySink& sink)
    : sink_(&sink), counter_(ports, rule, expected_tags) {
  for (const reader::ReadPort& port : ports) ports_.push_back({.port = port.port});
  last_weights_.reserve(ports.size());
}

void ReadIntake::take(std::span<const reader::TagRead> reads, const PoseHistory& history) {
  for (const reader::TagRead& read : reads) {
    counter_.add(read);
    const auto pose = history.at(read.heard, kPoseSlack);
    sink_->add({.read = read, .pose_world = pose.value_or(hal::Pose{}), .pose_known = pose.has_value()});
    reads_ += read.read_count;
    const auto tally =
        std::find_if(ports_.begin(), ports_.end(), [&](const PortTally& t) { return t.port == read.port; });
    if (tally != ports_.end()) tally->reads += read.read_count;
  }
}

void ReadIntake::credit(std::span<const reader::PortWeight> weights, double sign) {
  for (std::size_t i = 0; i < weights.size() && i < ports_.size(); ++i)
    ports_[i].new_tags += sign * weights[i].weight;
}

ClosedWindow ReadIntake::close_window() {
  const auto weights = counter_.close_window();
  credit(weights, 1.0);
  last_weights_.assign(weights.begin(), weights.end());
  unique_ = std::max(unique_, counter_.counted());
  ClosedWindow window;
  window.weights = weights;
  window.new_tags = counter_.new_tags();
  window.fresh_tags = static_cast<std::uint32_t>(unique_ - decided_on_);
  decided_on_ = unique_;
  return window;
}

void ReadIntake::keep_window() {
  credit(last_weights_, -1.0);
  counter_.reopen();
}

void ReadIntake::drop_window() {
  credit(counter_.close_window(), 1.0);
  unique_ = std::max(unique_, counter_.counted());
}

}  // namespace forager::flight
