#include "mocks/sim_docking_charger.hpp"

#include <cmath>

namespace forager::mocks {

SimDockingCharger::SimDockingCharger(const Options& options)
    : options_(options), slave_(options.unit, SimModbusSlave::Framing::rtu) {
  slave_.input = {{kStatus, 0}, {kCurrent, 0}};
  slave_.coils = {{kEnable, false}, {kClear, false}};
}

void SimDockingCharger::update(hal::Instant now) {
  if (slave_.coils[kClear]) fault_ = slave_.coils[kClear] = false;
  const bool enabled = slave_.coils[kEnable];
  if (enabled && !was_enabled_ && !docked) fault_ = true;
  was_enabled_ = enabled;
  if (!enabled || !docked || fault_) {
    enabled_since_.reset();
    live_ = false;
  } else {
    if (!enabled_since_) enabled_since_ = now;
    live_ = now - *enabled_since_ >= options_.closing;
  }
  slave_.input[kStatus] = static_cast<std::uint16_t>(
      (docked ? 1U << kDockedBit : 0U) | (live_ ? 1U << kChargingBit : 0U) | (fault_ ? 1U << kFaultBit : 0U));
  slave_.input[kCurrent] = static_cast<std::uint16_t>(std::lround(current_a() * 100.0));
}

}  // namespace forager::mocks
