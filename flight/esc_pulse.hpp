#pragma once

#include <cstdint>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::flight {

enum class EscProtocol : std::uint8_t {
  pwm,         // pulses as they are, 50 to 490 Hz
  oneshot125,  // pulses divided by 8 (125 to 250 us), up to 4 kHz; SimonK finds out by itself
};
[[nodiscard]] std::string_view to_string(EscProtocol protocol);

// What the pulses of one ESC mean. All in PWM terms, whatever the protocol. SimonK's own defaults: stops at
// 1060, full at 1860, throws pulses below 768 or above 2400 away.
struct EscPulses {
  EscProtocol protocol = EscProtocol::pwm;
  hal::Duration stop = std::chrono::microseconds(1000);  // arms, and stops
  hal::Duration idle = std::chrono::microseconds(1060);  // the longest at which the motor stands
  hal::Duration full = std::chrono::microseconds(1860);
  hal::Duration high = std::chrono::microseconds(2000);  // of a calibration
};

// Errors: invalid_argument (not 800 us <= stop <= idle < full <= high <= 2200 us; an idle of 1400 us or more,
// too near to where a calibration starts; a period outside 2.041 to 20 ms for PWM, 0.25 to 20 ms for
// OneShot125, or not above the longest pulse).
[[nodiscard]] hal::Result<> validate(const EscPulses& pulses, hal::Duration period);

// What goes on the line for a pulse in PWM terms.
[[nodiscard]] hal::Duration encode_pulse(hal::Duration pwm, EscProtocol protocol);

// Throttle of an armed ESC: 0 is idle, 1 full, linear between them. Below 0 is idle, above 1 full, NaN stop.
// PWM terms.
[[nodiscard]] hal::Duration pulse_of(double fraction, const EscPulses& pulses);

}  // namespace forager::flight
