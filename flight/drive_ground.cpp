#include "flight/drive_ground.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace forager::flight {

hal::Result<std::vector<servo::SteerStep>> steps_along(const std::vector<hal::Vec3>& way_world,
                                                       double step_m) {
  std::vector<servo::SteerStep> steps;
  const bool usable = way_world.size() >= 2 &&
                      std::all_of(way_world.begin(), way_world.end(), hal::is_finite) && step_m > 0.0;
  for (std::size_t i = 1; usable && i < way_world.size(); ++i) {
    const hal::Vec3 from = way_world[i - 1];
    const hal::Vec3 way = way_world[i] - from;
    const auto pieces = static_cast<int>(std::ceil(std::hypot(way.x, way.y) / step_m));
    for (int k = 1; k <= pieces; ++k) {
      const hal::Vec3 at = from + (static_cast<double>(k) / pieces) * way;
      steps.push_back({at.x, at.y});
    }
  }
  if (!steps.empty()) return steps;
  return hal::fail(hal::ErrorCode::invalid_argument, "ground driver", "plan steps",
                   "the way has no two different, finite corners");
}

DriveGround::DriveGround(const DriveGroundConfig& config, const DriveDevices& devices)
    : config_(config), devices_(devices) {
  devices_.left_brake.halt();
  devices_.right_brake.halt();
}

hal::Result<> DriveGround::do_begin(const std::vector<hal::Vec3>& way_world, hal::Instant now) {
  if (status_.state == GroundState::driving || status_.state == GroundState::failed)
    return hal::fail(hal::ErrorCode::invalid_state, "ground driver", "begin",
                     std::string("it is ") + std::string(to_string(status_.state)));
  auto steps = steps_along(way_world, config_.step_m);
  if (!steps) return hal::fail(std::move(steps).error());
  auto corridor = DriveCorridor::create(way_world, config_.corridor_half_width_m);
  if (!corridor) return hal::fail(std::move(corridor).error());
  loop_.reset();  // it lets go of the brakes' watch before the next one takes them
  loop_ = std::make_unique<DriveLoop>(
      config_.drive, devices_, DriveMission{*std::move(steps), std::nullopt, *std::move(corridor)}, now);
  status_ = {GroundState::driving, {}};
  return {};
}

void DriveGround::do_update(hal::Instant now) {
  if (!loop_) return;
  if (status_.state == GroundState::driving) {
    loop_->feed(now);
    loop_->go(now + config_.go_for);
  }
  loop_->update(now);
  if (status_.state != GroundState::driving || !loop_->done()) return;
  const DriveEnd end = loop_->status().end;
  status_.state = end == DriveEnd::arrived   ? GroundState::arrived
                  : end == DriveEnd::blocked ? GroundState::blocked
                  : end == DriveEnd::halted  ? GroundState::parked
                                             : GroundState::failed;
  status_.detail = loop_->status().detail;
}

void DriveGround::halt() noexcept {
  if (loop_ && status_.state == GroundState::driving) return loop_->halt();
  devices_.left_brake.halt();
  devices_.right_brake.halt();
}

}  // namespace forager::flight
