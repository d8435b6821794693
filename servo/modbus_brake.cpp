#include "servo/modbus_brake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace forager::servo {
namespace {

constexpr hal::Duration kLongestStep = std::chrono::milliseconds(100);  // as Servo's

}  // namespace

hal::Result<ModbusBrake> ModbusBrake::create(hal::Modbus& bus, const ModbusBrakeConfig& config) {
  if (config.open_value == config.locked_value || !(config.slew_per_s > 0.0) ||
      !std::isfinite(config.slew_per_s) || config.refresh <= hal::Duration::zero())
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + std::string(bus.name()), "create",
                     "open and locked are the same, or slew limit or refresh is not a positive number");
  if (config.target.table == RegisterTable::input)
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + std::string(bus.name()), "create",
                     "the target is an input register, which can only be read");
  FORAGER_TRY(check(config.target));
  if (config.measured) FORAGER_TRY(check(*config.measured));
  const auto open = encode(config.target, config.open_value);
  if (!open) return hal::fail(open.error());
  const auto locked = encode(config.target, config.locked_value);
  if (!locked) return hal::fail(locked.error());
  if (open->words == locked->words)
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + std::string(bus.name()), "create",
                     "open and locked are the same number in the target's register: its scale is too coarse");
  return ModbusBrake(bus, config);
}

ModbusBrake::ModbusBrake(hal::Modbus& bus, const ModbusBrakeConfig& config)
    : bus_(&bus), config_(config), name_(fmt::format("{} unit {}", bus.name(), config.unit)) {}

hal::Result<> ModbusBrake::do_move(double fraction, hal::Instant now) {
  if (std::isnan(fraction))
    return hal::fail(hal::ErrorCode::invalid_argument, "brake on " + name_, "move",
                     "not a number was commanded");
  const hal::Duration passed =
      last_ ? std::clamp(now - *last_, hal::Duration::zero(), kLongestStep) : hal::Duration::zero();
  last_ = now;
  const double step = config_.slew_per_s * hal::to_seconds(passed);
  FORAGER_TRY(tell(std::clamp(std::clamp(fraction, 0.0, 1.0), place_ - step, place_ + step), now));
  return measure(now);
}

hal::Result<> ModbusBrake::do_jump(double fraction, hal::Instant now) {
  if (std::isnan(fraction)) return do_move(fraction, now);
  last_ = now;
  FORAGER_TRY(tell(std::clamp(fraction, 0.0, 1.0), now));
  return measure(now);
}

void ModbusBrake::do_forget() {
  sent_.reset();
  enabled_ = false;
}

hal::Result<> ModbusBrake::tell(double place, hal::Instant now) {
  if (refresh_at_ && now >= *refresh_at_) do_forget();
  const bool anew = !sent_;
  FORAGER_TRY(send(place));
  if (anew || !refresh_at_) refresh_at_ = now + config_.refresh;
  return {};
}

hal::Result<> ModbusBrake::send(double place) {
  if (config_.enable_coil && !enabled_) {
    FORAGER_TRY(bus_->write_coil(config_.unit, *config_.enable_coil, true));
    enabled_ = true;
  }
  const double travel = config_.locked_value - config_.open_value;
  const auto target = encode(config_.target, config_.open_value + place * travel);
  if (!target) return hal::fail(target.error());
  if (sent_ != target->words) {
    sent_.reset();
    FORAGER_TRY(bus_->write_holding(config_.unit, config_.target.address, target->used()));
    sent_ = target->words;
  }
  place_ = place;
  return {};
}

hal::Result<> ModbusBrake::measure(hal::Instant now) {
  if (!config_.measured || (next_poll_ && now < *next_poll_)) return {};
  next_poll_ = now + config_.poll_interval;
  measured_.reset();
  const auto position = read(*bus_, config_.unit, *config_.measured);
  if (!position) return hal::fail(position.error());
  measured_ = (*position - config_.open_value) / (config_.locked_value - config_.open_value);
  return {};
}

void ModbusBrake::halt() noexcept {
  do_forget();
  static_cast<void>(send(1.0));
}

}  // namespace forager::servo
