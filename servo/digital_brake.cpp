#include "servo/digital_brake.hpp"

#include <cmath>
#include <string>

namespace forager::servo {

hal::Result<> DigitalBrake::do_move(double fraction, hal::Instant) {
  if (std::isnan(fraction))
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + std::string(line_->name()), "move",
                     "not a number was commanded");
  return lock(fraction >= 0.5);
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
