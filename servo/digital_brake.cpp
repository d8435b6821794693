#include "servo/digital_brake.hpp"

#include <cmath>
#include <string>

namespace forager::servo {
namespace {

constexpr hal::Duration kRefresh = std::chrono::milliseconds(500);  // as Servo's

}  // namespace

hal::Result<> DigitalBrake::do_move(double fraction, hal::Instant now) {
  if (std::isnan(fraction))
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + std::string(line_->name()), "move",
                     "not a number was commanded");
  if (refresh_at_ && now >= *refresh_at_) sent_.reset();
  const bool locks = fraction >= 0.5;
  const bool tells = sent_ != locks;
  FORAGER_TRY(lock(locks));
  if (tells || !refresh_at_) refresh_at_ = now + kRefresh;
  return {};
}

hal::Result<> DigitalBrake::lock(bool locked) {
  if (sent_ == locked) return {};
  sent_.reset();
  FORAGER_TRY(line_->set(locked == (active_ == WhenActive::locks)));
  sent_ = locked_ = locked;
  return {};
}

void DigitalBrake::halt() noexcept {
  sent_.reset();
  static_cast<void>(lock(true));
}

}  // namespace forager::servo
