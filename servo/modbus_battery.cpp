#include "servo/modbus_battery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace forager::servo {
namespace {

constexpr std::size_t kQuantities = 4;
constexpr double kChargeSlack = 0.05;  // gauges count to 100 % and a little more

const ModbusRegister* quantity(const ModbusBatteryConfig& config, std::size_t index) {
  const auto given = [](const std::optional<ModbusRegister>& r) { return r ? &*r : nullptr; };
  const std::array<const ModbusRegister*, kQuantities> all{&config.voltage, &config.charge,
                                                           given(config.current), given(config.temperature)};
  return all.at(index);
}

}  // namespace

hal::Result<ModbusBattery> ModbusBattery::create(hal::Modbus& bus, ModbusBatteryConfig config) {
  for (std::size_t i = 0; i < kQuantities; ++i)
    if (const ModbusRegister* known = quantity(config, i)) FORAGER_TRY(check(*known));
  if (config.poll_interval <= hal::Duration::zero() || config.stale_after <= hal::Duration::zero())
    return hal::fail(hal::ErrorCode::invalid_argument, "battery on " + std::string(bus.name()), "create",
                     "intervals must be positive");
  return ModbusBattery(bus, std::move(config));
}

ModbusBattery::ModbusBattery(hal::Modbus& bus, ModbusBatteryConfig config)
    : bus_(&bus),
      config_(std::move(config)),
      name_(fmt::format("battery on {} unit {}", bus.name(), config_.unit)) {}

hal::Result<> ModbusBattery::update(hal::Instant now) {
  if (next_ == 0) {
    if (next_set_ && now < *next_set_) return {};
    next_set_ = now + config_.poll_interval;
    coming_ = {.at = now};
  }
  auto value = read(*bus_, config_.unit, *quantity(config_, next_));
  auto taken = value ? take(next_, *value) : hal::Result<>(hal::fail(std::move(value).error()));
  if (!taken) {
    next_ = 0;
    return taken;
  }
  do {
    ++next_;
  } while (next_ < kQuantities && quantity(config_, next_) == nullptr);
  if (next_ < kQuantities) return {};
  next_ = 0;
  reading_ = coming_;
  return {};
}

hal::Result<> ModbusBattery::take(std::size_t index, double value) {
  switch (index) {
    case 0:
      coming_.voltage_v = value;
      break;
    case 1:
      if (value < -kChargeSlack || value > 1.0 + kChargeSlack)
        return hal::fail(hal::ErrorCode::protocol, name_, "read " + config_.charge.name,
                         fmt::format("{} is no charge from 0 to 1", value),
                         "Compare scale, type and address of the register with the gauge's manual");
      coming_.charge = std::clamp(value, 0.0, 1.0);
      break;
    case 2:
      coming_.current_a = value;
      break;
    default:
      coming_.temperature_c = value;
      break;
  }
  return {};
}

bool ModbusBattery::stale(hal::Instant now) const {
  return !reading_ || now - reading_->at > config_.stale_after;
}

}  // namespace forager::servo
