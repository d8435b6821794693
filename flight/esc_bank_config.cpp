#include <fmt/format.h>

#include <cmath>

#include "flight/esc_bank.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kEscStopsItself = 131ms;  // two timer rounds of 65.5 ms (SimonK)
constexpr int kLeastPulses = 11;                  // more than 10 (SimonK)

hal::Failure wrong(std::string detail) {
  return hal::fail(hal::ErrorCode::invalid_argument, "ESCs", "configure", std::move(detail));
}

bool positive(double value) { return value > 0.0; }

}  // namespace

hal::Result<> validate(const EscBankConfig& config, hal::Duration period) {
  FORAGER_TRY(validate(config.pulses, period));
  if (!positive(config.rise_per_s) || !positive(config.fall_per_s))
    return wrong("a throttle rate is not positive");
  if (!(config.most_throttle >= 0.0 && config.most_throttle <= 1.0))
    return wrong(fmt::format("a throttle limit of {} is not in 0..1", config.most_throttle));
  if (config.command_max_age <= hal::Duration::zero() || config.command_max_age >= kEscStopsItself)
    return wrong(fmt::format("a command age of {:.1f} ms is not between 0 and the 131 ms of the ESC itself",
                             hal::to_seconds(config.command_max_age) * 1e3));
  const EscArmingTimes& arming = config.arming;
  if (arming.pulses_before_power < 1 || arming.pulses_to_arm < kLeastPulses)
    return wrong(fmt::format("{} pulses before power and {} to arm; at least 1 and {} are needed",
                             arming.pulses_before_power, arming.pulses_to_arm, kLeastPulses));
  const EscCalibrationTimes& levels = config.calibration;
  for (const hal::Duration time :
       {arming.beeps, arming.low_at_least, levels.cold, levels.connect, levels.high, levels.low})
    if (time < hal::Duration::zero()) return wrong("a time is negative");
  return {};
}

}  // namespace forager::flight
