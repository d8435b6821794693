#include "flight/tag_memory.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr double kForgotten = 0.05;  // a place with less than this many tags is no place

}  // namespace

void TagMemory::hear(const hal::Pose& pose_world, std::span<const reader::PortWeight> weights,
                     hal::Instant now) {
  const double age_s = faded_at_ ? hal::to_seconds(now - *faded_at_) : 0.0;
  const double keep = std::exp2(-age_s / config_.half_life_s);
  faded_at_ = now;
  for (Place& place : places_) place.weight *= keep;
  for (const reader::PortWeight& port : weights) {
    if (port.weight <= 0.0) continue;
    const double bearing = pose_world.yaw_rad + port.bearing_rad;
    add(pose_world.position + config_.heard_at_m * hal::Vec3{std::cos(bearing), std::sin(bearing), 0.0},
        port.weight);
  }
  for (Place& place : places_)
    if (place.weight < kForgotten ||
        hal::distance_xy(place.position_world, pose_world.position) < config_.visited_m)
      place.weight = 0.0;
}

void TagMemory::add(hal::Vec3 position_world, double weight) {
  Place* weakest = &places_.front();
  for (Place& place : places_) {
    if (place.weight > 0.0 && hal::distance_xy(place.position_world, position_world) < config_.merge_m) {
      place.weight += weight;
      return;
    }
    if (place.weight < weakest->weight) weakest = &place;
  }
  if (weakest->weight < weight) *weakest = {position_world, weight};
}

void TagMemory::forget_towards(const hal::Pose& pose_world, double heading_rad, double half_sector_rad) {
  for (Place& place : places_) {
    const hal::Vec3 way = place.position_world - pose_world.position;
    if (place.weight > 0.0 && std::hypot(way.x, way.y) <= config_.heard_at_m + config_.merge_m &&
        std::abs(hal::angle_difference(std::atan2(way.y, way.x), heading_rad)) <= half_sector_rad)
      place.weight = 0.0;
  }
}

hal::Vec3 TagMemory::pull_world(const hal::Pose& pose_world) const {
  hal::Vec3 pull;
  for (const Place& place : places_) {
    const hal::Vec3 way = place.position_world - pose_world.position;
    const double distance = std::hypot(way.x, way.y);
    if (place.weight > 0.0 && distance > 0.0)
      pull = pull + (place.weight / distance) * hal::Vec3{way.x, way.y, 0.0};
  }
  return pull;
}

}  // namespace forager::flight
