#include "servo/pwm_brake.hpp"

#include <utility>

namespace forager::servo {

using namespace std::chrono_literals;

PwmBrakeConfig laboratory_left() { return {.open_pulse = 1180us, .locked_pulse = 1725us}; }
PwmBrakeConfig laboratory_right() { return {.open_pulse = 1180us, .locked_pulse = 1875us}; }

hal::Result<PwmBrake> PwmBrake::create(hal::PwmChannel& channel, const PwmBrakeConfig& config) {
  auto map = PulseMap::between({0.0, config.open_pulse}, {1.0, config.locked_pulse});
  if (!map) return hal::fail(std::move(map).error());
  auto servo = Servo::create(channel, *std::move(map),
                             {.safe = 1.0,
                              .slew_per_s = config.slew_per_s,
                              .trim = config.trim,
                              .min_pulse = config.min_pulse,
                              .max_pulse = config.max_pulse,
                              .at_halt = config.at_halt});
  if (!servo) return hal::fail(std::move(servo).error());
  return PwmBrake(*std::move(servo));
}

}  // namespace forager::servo
