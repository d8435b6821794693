#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/pose.hpp"
#include "hal/time.hpp"

namespace forager::flight {

// The last poses of the body, to say where it was when a tag was heard: reads arrive up to some seconds after
// they were made. 512 poses are 17 s of a 30 Hz camera. World frame; position and yaw are interpolated
// linearly (yaw the short way round), pitch and roll are those of the older neighbour.
class PoseHistory {
 public:
  // Poses not newer than the newest are ignored.
  void add(hal::Instant stamp, const hal::Pose& pose_world);
  // Forgets everything: the world frame itself has moved.
  void clear() { size_ = 0; }
  // nullopt if `when` is before the oldest pose, or after the newest by more than `slack`.
  [[nodiscard]] std::optional<hal::Pose> at(hal::Instant when, hal::Duration slack) const;

 private:
  struct Entry {
    hal::Instant stamp;
    hal::Pose pose_world;
  };
  static constexpr std::size_t kCapacity = 512;
  // i-th oldest
  [[nodiscard]] const Entry& entry(std::size_t i) const {
    return entries_[(next_ + kCapacity - size_ + i) % kCapacity];
  }

  std::array<Entry, kCapacity> entries_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace forager::flight
