#include "flight/pose_history.hpp"

#include <algorithm>

#include "hal/units.hpp"

namespace forager::flight {

void PoseHistory::add(hal::Instant stamp, const hal::Pose& pose_world) {
  if (size_ > 0 && stamp <= entry(size_ - 1).stamp) return;
  entries_[next_] = {stamp, pose_world};
  next_ = (next_ + 1) % kCapacity;
  size_ = std::min(size_ + 1, kCapacity);
}

std::optional<hal::Pose> PoseHistory::at(hal::Instant when, hal::Duration slack) const {
  if (size_ == 0 || when < entry(0).stamp) return std::nullopt;
  const Entry& newest = entry(size_ - 1);
  if (when >= newest.stamp) {
    if (when - newest.stamp > slack) return std::nullopt;
    return newest.pose_world;
  }
  std::size_t low = 0;  // entry(low).stamp <= when < entry(high).stamp
  std::size_t high = size_ - 1;
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (entry(middle).stamp <= when ? low : high) = middle;
  }
  const Entry& before = entry(low);
  const Entry& after = entry(high);
  const double share = hal::to_seconds(when - before.stamp) / hal::to_seconds(after.stamp - before.stamp);
  hal::Pose pose = before.pose_world;
  pose.position = pose.position + share * (after.pose_world.position - before.pose_world.position);
  pose.yaw_rad = hal::wrap_pi(
      pose.yaw_rad + share * hal::angle_difference(after.pose_world.yaw_rad, before.pose_world.yaw_rad));
  return pose;
}

}  // namespace forager::flight
