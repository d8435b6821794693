#include "servo/servo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::servo {
namespace {

hal::Failure refuse(const hal::PwmChannel& channel, std::string_view operation, std::string why) {
  return hal::fail(hal::ErrorCode::invalid_argument, "servo on " + std::string(channel.name()),
                   std::string(operation), std::move(why));
}

}  // namespace

hal::Result<Servo> Servo::create(hal::PwmChannel& channel, PulseMap map, const ServoConfig& config) {
  if (!(config.slew_per_s > 0.0)) return refuse(channel, "create", "the slew limit is not positive");
  if (!(config.safe >= map.first() && config.safe <= map.last()))
    return refuse(
        channel, "create",
        fmt::format("the safe place, {}, is not from {} to {}", config.safe, map.first(), map.last()));
  if (config.longest_step <= hal::Duration::zero())
    return refuse(channel, "create", "the longest step is not positive");
  if (config.refresh <= hal::Duration::zero() || config.release_after <= hal::Duration::zero())
    return refuse(channel, "create", "the time until a refresh or a release is not positive");
  const auto [low, high] = std::minmax(map.points().front().pulse, map.points().back().pulse);
  if (config.min_pulse <= hal::Duration::zero() || config.min_pulse >= config.max_pulse ||
      high + config.trim <= config.min_pulse || low + config.trim >= config.max_pulse)
    return refuse(channel, "create",
                  fmt::format("end stops {} to {} us leave nothing of the travel {} to {} us",
                              config.min_pulse / std::chrono::microseconds(1),
                              config.max_pulse / std::chrono::microseconds(1),
                              (low + config.trim) / std::chrono::microseconds(1),
                              (high + config.trim) / std::chrono::microseconds(1)));
  return Servo(channel, std::move(map), config);
}

hal::Result<> Servo::move(double target, hal::Instant now) {
  if (std::isnan(target)) return refuse(*channel_, "move", "not a number was commanded");
  // A first command has no time behind it: it only tells the servo to be where it is taken to be.
  const hal::Duration passed =
      last_ ? std::clamp(now - *last_, hal::Duration::zero(), config_.longest_step) : hal::Duration::zero();
  last_ = now;
  const double step = config_.slew_per_s * hal::to_seconds(passed);
  const double wanted = std::clamp(target, map_.first(), map_.last());
  const hal::Result<bool> rests = released(wanted, now);
  if (!rests) return hal::fail(rests.error());
  if (*rests) return {};
  if (std::isnan(step)) return send(place_, now);  // no limit, and no time: still where it is taken to be
  // Sums of steps miss the target by rounding; what is nearer than that is there.
  constexpr double kThere = 1e-9;
  if (std::abs(wanted - place_) <= step + kThere * (map_.last() - map_.first())) return send(wanted, now);
  return send(wanted > place_ ? place_ + step : place_ - step, now);
}

// After halt(), and as long as it is to stay at the safe place: whether its pulses have ended, or end now.
hal::Result<bool> Servo::released(double wanted, hal::Instant now) {
  if (wanted != config_.safe) halted_ = false;
  if (!halted_ || config_.at_halt != AtHalt::release) return false;
  if (released_) return true;
  if (place_ != config_.safe || !sent_) return false;  // it did not hear of it
  if (!halted_at_) halted_at_ = now;
  if (now - *halted_at_ < config_.release_after) return false;
  FORAGER_TRY(channel_->release());
  sent_.reset();
  released_ = true;
  return true;
}

hal::Result<> Servo::jump(double target, hal::Instant now) {
  if (std::isnan(target)) return refuse(*channel_, "jump", "not a number was commanded");
  last_ = now;
  halted_ = false;
  return send(std::clamp(target, map_.first(), map_.last()), now);
}

hal::Result<> Servo::send(double place, hal::Instant now) {
  if (sent_at_ && now - *sent_at_ >= config_.refresh) sent_.reset();
  const bool anew = !sent_;
  const std::optional<hal::Duration> before = sent_;
  FORAGER_TRY(send(place));
  if (anew || sent_ != before || !sent_at_) sent_at_ = now;
  return {};
}

hal::Result<> Servo::send(double place) {
  const hal::Duration pulse =
      std::clamp(map_.pulse(place).value() + config_.trim, config_.min_pulse, config_.max_pulse);
  if (sent_ != pulse) {
    sent_.reset();  // after a failure nobody knows what the output does
    FORAGER_TRY(channel_->set_pulse(pulse));
    sent_ = pulse;
  }
  place_ = place;
  return {};
}

void Servo::halt() noexcept {
  sent_.reset();  // send it even if it is the pulse that was sent last: an output may have lost it
  static_cast<void>(send(config_.safe));
  halted_ = true;
  halted_at_.reset();
  released_ = false;
}

}  // namespace forager::servo
