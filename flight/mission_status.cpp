#include "flight/mission_status.hpp"

namespace forager::flight {

std::string_view to_string(MissionPhase phase) {
  switch (phase) {
    case MissionPhase::waiting:
      return "waiting";
    case MissionPhase::guided:
      return "guided";
    case MissionPhase::arming:
      return "arming";
    case MissionPhase::takeoff:
      return "takeoff";
    case MissionPhase::listening:
      return "listening";
    case MissionPhase::stepping:
      return "stepping";
    case MissionPhase::landing:
      return "landing";
    case MissionPhase::silent:
      return "silent";
    case MissionPhase::storing:
      return "storing";
    case MissionPhase::done:
      return "done";
  }
  return "?";
}

void FlownPath::add(hal::Instant now, const hal::Pose& pose_world) {
  // Counted in steps well above the noise of a hovering camera: noise must not add up to a way.
  constexpr double kNoiseM = 0.05;
  if (!counted_to_) counted_to_ = pose_world.position;
  if (const double moved_m = hal::distance_xy(*counted_to_, pose_world.position); moved_m >= kNoiseM) {
    length_m_ += moved_m;
    counted_to_ = pose_world.position;
  }
  if (!points_.empty() && hal::norm(points_.back().pose_world.position - pose_world.position) < spacing_m_)
    return;
  if (points_.size() == capacity_) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points_.size(); i += 2) points_[kept++] = points_[i];
    points_.resize(kept);
    spacing_m_ *= 2.0;
  }
  points_.push_back({now, pose_world});
}

}  // namespace forager::flight
