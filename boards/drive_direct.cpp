#include "boards/drive_direct.hpp"

#include <algorithm>
#include <cmath>

namespace forager::boards {
namespace {

constexpr hal::Duration kAttitudePeriod = std::chrono::milliseconds(20);

}  // namespace

DirectAutopilot::DirectAutopilot(mocks::RollingVehicle& vehicle, const DriveScene& scene,
                                 const DrivePlantDraw& draw, std::uint64_t seed)
    : vehicle_(&vehicle),
      random_(seed),
      gyro_noise_(draw.gyro_noise_rad_s),
      gyro_bias_(draw.gyro_bias_rad_s),
      timeout_(hal::from_seconds(scene.guided_timeout_s)) {}

void DirectAutopilot::update(hal::Instant now) {
  if (cut_) return;
  state_.link_up = true;
  state_.last_heartbeat = now;
  state_.pose_valid = true;
  if (asked_ != Ask::none) {
    if (asked_ == Ask::guided) state_.guided = true;
    if (asked_ == Ask::arm) armed_ = true;
    if (asked_ == Ask::disarm) armed_ = false;
    asked_ = Ask::none;
    request_ = flight::RequestState::accepted;
  }
  state_.armed = armed_;
  if (pilot_) state_.guided = false;
  if (now >= next_attitude_) {
    next_attitude_ = now + kAttitudePeriod;
    heard_ = now;
    yaw_rate_ = vehicle_->state().yaw_rate_rad_s + gyro_bias_ + gyro_noise_ * random_.normal();
  }
}

void DirectAutopilot::run(hal::Instant now) {
  if (!cut_ && fresh_ && told_) {
    fresh_ = false;
    told_at_ = now;
    thrust_ = told_->thrust;
    pitch_ = told_->pitch_rad;
  } else if (now - told_at_ > timeout_) {
    pitch_ = 0.0;  // levels; thrust stays what it was
  }
  vehicle_->set_armed(armed_);
}

std::optional<double> DirectAutopilot::take_yaw_rate() {
  const auto rate = yaw_rate_;
  yaw_rate_.reset();
  return rate;
}

hal::Result<> DirectBrake::do_move(double fraction, hal::Instant) {
  if (std::isnan(fraction))
    return hal::fail(hal::ErrorCode::invalid_argument, name_, "move brake", "the fraction is not a number");
  told_ = std::clamp(fraction, 0.0, 1.0);
  return {};
}

hal::Result<> BrakeKeeper::do_set(bool active) {
  if (active != level_) changed_ = now_;
  level_ = active;
  return {};
}

}  // namespace forager::boards
