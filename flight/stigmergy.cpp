#include "flight/stigmergy.hpp"

#include <algorithm>
#include <cmath>

#include "hal/units.hpp"

namespace forager::flight {
namespace {

constexpr double kTrailKept = 0.6;  // per step
constexpr double kPullKept = 0.7;   // per window

}  // namespace

Pull pull_of(std::span<const reader::PortWeight> weights, bool winner_takes_all) {
  double most = 0.0;
  for (const reader::PortWeight& port : weights) most = std::max(most, port.weight);
  Pull pull;
  for (const reader::PortWeight& port : weights) {
    pull.total += port.weight;
    if (winner_takes_all && port.weight < most) continue;
    pull.vector_body = pull.vector_body +
                       port.weight * hal::Vec3{std::cos(port.bearing_rad), std::sin(port.bearing_rad), 0.0};
  }
  pull.length = std::hypot(pull.vector_body.x, pull.vector_body.y);
  if (pull.length <= 1e-9 * pull.total) {
    pull.vector_body = {};
    pull.length = 0.0;
  } else {
    pull.theta_rad = hal::wrap_pi(std::atan2(pull.vector_body.y, pull.vector_body.x));
  }
  return pull;
}

Stigmergy::Stigmergy(const StigmergyConfig& config)
    : config_(config), memory_({.half_life_s = config.memory_half_life_s}) {
  if (config_.heights_m.empty()) config_.heights_m.push_back(0.0);
}

Step Stigmergy::finish(Step step) const {
  step.height_m = config_.heights_m[height_];
  step.listen = looking_ ? hal::Duration::zero() : config_.window;
  return step;
}

Step Stigmergy::begin(const hal::Pose& pose_world) {
  last_position_world_ = pose_world.position;
  trail_world_ = {std::cos(pose_world.yaw_rad), std::sin(pose_world.yaw_rad), 0.0};
  return finish(stay_at(pose_world));
}

void Stigmergy::learn(const Observation& seen) {
  if (seen.moved_m > 0.0)
    trail_world_ = kTrailKept * trail_world_ + (seen.pose_world.position - last_position_world_);
  last_position_world_ = seen.pose_world.position;
  if (config_.memory) memory_.hear(seen.pose_world, seen.weights, seen.now);
  const Pull pull = pull_of(seen.weights, config_.winner_takes_all);
  if (pull.length > 0.0)
    recent_pull_world_ = kPullKept * recent_pull_world_ +
                         (1.0 / pull.length) * hal::rotate_yaw(pull.vector_body, seen.pose_world.yaw_rad);
  if (seen.fresh_tags > 0) searched_ = looks_ = 0;
  if (seen.fresh_tags > 0) heights_tried_ = 0;
  if (!seen.blocked) return;
  const double heading = seen.pose_world.yaw_rad;
  if (seen.new_tags == 0) memory_.forget_towards(seen.pose_world, heading, config_.blocked_sector_rad);
  blocked_[next_blocked_] = {seen.pose_world.position, heading, seen.now + config_.blocked_for};
  next_blocked_ = (next_blocked_ + 1) % blocked_.size();
}

bool Stigmergy::known_blocked(const Observation& seen, double heading_rad) const {
  return std::any_of(blocked_.begin(), blocked_.end(), [&](const Blocked& b) {
    return seen.now < b.until &&
           hal::distance_xy(b.place_world, seen.pose_world.position) < config_.same_place_m &&
           std::abs(hal::angle_difference(b.heading_rad, heading_rad)) <= config_.blocked_sector_rad;
  });
}

Step Stigmergy::decide(const Observation& seen) {
  learn(seen);
  const Step step = choose(seen);
  return finish(step);
}

Step Stigmergy::choose(const Observation& seen) {
  if (looking_) {
    looking_ = false;
    if (seen.blocked && seen.fresh_tags == 0) return search(seen);
    if (!seen.blocked) ++searched_;
    if (seen.new_tags == 0) return stay_at(seen.pose_world);
  }
  if (seen.tries == 0) return seen.new_tags > 0 ? follow(seen) : stay_at(seen.pose_world);
  const bool more_heights = heights_tried_ + 1 < config_.heights_m.size();
  if (seen.tries >= config_.tries && !more_heights) return land_now(seen.pose_world, EndReason::no_new_tags);
  const bool facing_blocked = known_blocked(seen, seen.pose_world.yaw_rad);
  if (seen.tries == 1 && !facing_blocked) return stay_at(seen.pose_world);
  if (more_heights) {
    ++heights_tried_;
    height_ = (height_ + 1) % config_.heights_m.size();
    return stay_at(seen.pose_world);
  }
  return search(seen);
}

Step Stigmergy::follow(const Observation& seen) const {
  const hal::Pose& here = seen.pose_world;
  Pull pull = pull_of(seen.weights, config_.winner_takes_all);
  if (config_.memory) {
    const hal::Vec3 remembered_body = hal::rotate_yaw(memory_.pull_world(here), -here.yaw_rad);
    pull.vector_body = pull.vector_body + remembered_body;
    pull.length = std::hypot(pull.vector_body.x, pull.vector_body.y);
    pull.theta_rad = pull.length > 0.0 ? std::atan2(pull.vector_body.y, pull.vector_body.x) : 0.0;
  }
  if (pull.length <= config_.significance * std::sqrt(pull.total)) {
    Step undecided = stay_at(here);
    undecided.consume_tags = false;
    return undecided;
  }
  const double heading = hal::wrap_pi(here.yaw_rad + pull.theta_rad);
  if (known_blocked(seen, heading)) return stay_at(here);
  return step_along(heading, config_.step_m, here);
}

Step Stigmergy::search(const Observation& seen) {
  if (searched_ >= config_.search_steps || looks_ >= config_.search_looks) return stay_at(seen.pose_world);
  const auto heading = free_heading(seen);
  if (!heading) return stay_at(seen.pose_world);
  looking_ = true;
  ++looks_;
  return step_along(*heading, config_.step_m, seen.pose_world);
}

std::optional<double> Stigmergy::free_heading(const Observation& seen) const {
  const double along = std::atan2(trail_world_.y, trail_world_.x);
  const bool pulled = recent_pull_world_ != hal::Vec3{};
  const double wanted = pulled ? std::atan2(recent_pull_world_.y, recent_pull_world_.x) : along;
  const double first_side = hal::angle_difference(along, wanted) < 0.0 ? -1.0 : 1.0;
  const int sectors = static_cast<int>(hal::kPi / config_.blocked_sector_rad);
  for (int i = 0; i <= sectors; ++i)
    for (const double side : {first_side, -first_side}) {
      const double heading = hal::wrap_pi(wanted + side * i * config_.blocked_sector_rad);
      if (!known_blocked(seen, heading)) return heading;
    }
  return std::nullopt;
}

}  // namespace forager::flight
