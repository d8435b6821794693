#include "servo/modbus_charger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace forager::servo {

hal::Result<ModbusCharger> ModbusCharger::create(hal::Modbus& bus, ModbusChargerConfig config) {
  FORAGER_TRY(check(config.status));
  if (config.current) FORAGER_TRY(check(*config.current));
  const auto wrong = [&](const char* what) {
    return hal::fail(hal::ErrorCode::invalid_argument, "charger on " + std::string(bus.name()), "create",
                     what);
  };
  if (config.status.type != RegisterType::u16 || config.status.scale != 1.0 || config.status.offset != 0.0)
    return wrong("the status must be a plain u16");
  if (std::max({config.docked_bit, config.charging_bit, config.fault_bit}) > 15)
    return wrong("the bits of the status are numbered 0 to 15");
  if (config.poll_interval <= hal::Duration::zero() || config.stale_after <= hal::Duration::zero())
    return wrong("intervals must be positive");
  return ModbusCharger(bus, std::move(config));
}

ModbusCharger::ModbusCharger(hal::Modbus& bus, ModbusChargerConfig config)
    : bus_(&bus),
      config_(std::move(config)),
      name_(fmt::format("charger on {} unit {}", bus.name(), config_.unit)) {}

hal::Result<> ModbusCharger::update(hal::Instant now) {
  auto asked = ask(now);
  const bool wanted = wanted_until_ && now < *wanted_until_;
  const bool on = wanted && !stale(now) && reading_->docked && !reading_->fault;
  // Off is said even when the question failed: the answer may be what is broken.
  if (enabled_ != on) FORAGER_TRY(enable(on));
  return asked;
}

hal::Result<> ModbusCharger::ask(hal::Instant now) {
  if (next_poll_ && now < *next_poll_) return {};
  if (std::exchange(current_next_, false)) {
    next_poll_ = now + config_.poll_interval;
    auto current = read(*bus_, config_.unit, *config_.current);
    if (!current) return hal::fail(std::move(current).error());
    if (reading_) reading_->current_a = *current;
    return {};
  }
  current_next_ = config_.current.has_value();
  if (!current_next_) next_poll_ = now + config_.poll_interval;
  const auto status = read(*bus_, config_.unit, config_.status);
  if (!status) return hal::fail(status.error());
  const auto bits = static_cast<std::uint32_t>(std::lround(*status));
  const auto has = [bits](std::uint8_t bit) { return (bits >> bit & 1U) != 0; };
  ChargerReading next{has(config_.docked_bit), has(config_.charging_bit), has(config_.fault_bit), {}, now};
  if (reading_) next.current_a = reading_->current_a;
  reading_ = next;
  return {};
}

hal::Result<> ModbusCharger::enable(bool on) {
  enabled_.reset();
  FORAGER_TRY(bus_->write_coil(config_.unit, config_.enable_coil, on));
  enabled_ = on;
  return {};
}

bool ModbusCharger::stale(hal::Instant now) const {
  return !reading_ || now - reading_->at > config_.stale_after;
}

void ModbusCharger::halt() noexcept {
  wanted_until_.reset();
  static_cast<void>(enable(false));
}

}  // namespace forager::servo
