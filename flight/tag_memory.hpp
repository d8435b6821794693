#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "hal/pose.hpp"
#include "hal/time.hpp"
#include "reader/new_tag_counter.hpp"

namespace forager::flight {

struct TagMemoryConfig {
  double half_life_s = 60.0;
  double heard_at_m = 3.0;  // how far off a tag is taken to be along its antenna's bearing
  double visited_m = 1.5;   // a place nearer than this is no news any more
  double merge_m = 1.0;     // places nearer to each other than this are one
};

// Places where new tags were heard and the vehicle has not been yet: the trace that draws it on when nothing
// new is heard. A fixed number of places; the weakest gives way. World frame, weights in tags.
class TagMemory {
 public:
  explicit TagMemory(const TagMemoryConfig& config) : config_(config) {}

  // Fades everything to `now`, then adds what was heard from here and forgets what lies here.
  void hear(const hal::Pose& pose_world, std::span<const reader::PortWeight> weights, hal::Instant now);
  // Nothing can be reached from here along this heading: forget the places behind it.
  void forget_towards(const hal::Pose& pose_world, double heading_rad, double half_sector_rad);

  // Sum of weight times unit direction over all places, world frame.
  [[nodiscard]] hal::Vec3 pull_world(const hal::Pose& pose_world) const;

  struct Place {
    hal::Vec3 position_world;
    double weight = 0.0;  // 0: free
  };
  [[nodiscard]] std::span<const Place> places() const { return places_; }

 private:
  void add(hal::Vec3 position_world, double weight);

  TagMemoryConfig config_;
  std::array<Place, 32> places_{};
  std::optional<hal::Instant> faded_at_;
};

}  // namespace forager::flight
