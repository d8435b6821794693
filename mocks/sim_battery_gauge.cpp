#include "mocks/sim_battery_gauge.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace forager::mocks {
namespace {

constexpr double kSecondsPerHour = 3600.0;

std::uint16_t signed_word(double value) {
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(value)));
}

}  // namespace

SimBatteryGauge::SimBatteryGauge(const Options& options)
    : options_(options), slave_(options.unit, SimModbusSlave::Framing::rtu), charge_(options.charge) {
  const auto mah = static_cast<std::uint32_t>(std::lround(options.capacity_ah * 1000.0));
  slave_.holding[kCapacity] = static_cast<std::uint16_t>(mah & 0xFFFFU);
  slave_.holding[kCapacity + 1] = static_cast<std::uint16_t>(mah >> 16);
  show();
}

double SimBatteryGauge::voltage_v() const {
  return options_.empty_v + charge_ * (options_.full_v - options_.empty_v) +
         current_a * options_.resistance_ohm;
}

void SimBatteryGauge::update(hal::Instant now) {
  const double passed_s = last_ ? hal::to_seconds(now - *last_) : 0.0;
  last_ = now;
  charge_ = std::clamp(charge_ + current_a * passed_s / (options_.capacity_ah * kSecondsPerHour), 0.0, 1.0);
  show();
}

void SimBatteryGauge::show() {
  slave_.input[kVoltage] = static_cast<std::uint16_t>(std::lround(voltage_v() * 100.0));
  slave_.input[kCurrent] = signed_word(current_a * 10.0);
  slave_.input[kTemperature] = signed_word(temperature_c * 10.0);
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(100.0 * charge_));
  slave_.input[kCharge] = static_cast<std::uint16_t>(bits >> 16);
  slave_.input[kCharge + 1] = static_cast<std::uint16_t>(bits & 0xFFFFU);
}

}  // namespace forager::mocks
