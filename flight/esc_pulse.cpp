#include "flight/esc_pulse.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

constexpr hal::Duration kLeastPulse = 800us;  // SimonK throws pulses below 768 away
constexpr hal::Duration kMostPulse = 2200us;  // and above 2400
constexpr hal::Duration kMostIdle = 1400us;   // a calibration starts at 1460
constexpr hal::Duration kSlowest = 20ms;      // 50 Hz
constexpr hal::Duration kFastestPwm = 2040816ns;
constexpr hal::Duration kFastestOneshot = 250us;
constexpr int kOneshotShare = 8;

double us(hal::Duration d) { return std::chrono::duration<double, std::micro>(d).count(); }

hal::Failure wrong(std::string detail, std::string mend = {}) {
  return hal::fail(hal::ErrorCode::invalid_argument, "ESCs", "configure pulses", std::move(detail),
                   std::move(mend));
}

hal::Result<> validate_period(const EscPulses& pulses, hal::Duration period) {
  const bool oneshot = pulses.protocol == EscProtocol::oneshot125;
  const hal::Duration fastest = oneshot ? kFastestOneshot : kFastestPwm;
  if (period < fastest || period > kSlowest)
    return wrong(fmt::format("a period of {:.1f} us is outside {:.1f} to {:.1f} us for {}", us(period),
                             us(fastest), us(kSlowest), to_string(pulses.protocol)),
                 oneshot ? "50 Hz to 4 kHz" : "50 to 490 Hz; more needs OneShot125");
  const hal::Duration longest = encode_pulse(pulses.high, pulses.protocol);
  if (period <= longest)
    return wrong(fmt::format("a pulse of {:.1f} us leaves no low time in a period of {:.1f} us", us(longest),
                             us(period)));
  return {};
}

}  // namespace

std::string_view to_string(EscProtocol protocol) {
  return protocol == EscProtocol::oneshot125 ? "OneShot125" : "PWM";
}

hal::Result<> validate(const EscPulses& pulses, hal::Duration period) {
  if (pulses.stop < kLeastPulse || pulses.high > kMostPulse)
    return wrong(fmt::format("stop {:.1f} us or high {:.1f} us is outside {:.0f} to {:.0f} us",
                             us(pulses.stop), us(pulses.high), us(kLeastPulse), us(kMostPulse)));
  if (pulses.stop > pulses.idle || pulses.idle >= pulses.full || pulses.full > pulses.high)
    return wrong(fmt::format("stop {:.1f}, idle {:.1f}, full {:.1f}, high {:.1f} us are not in this order",
                             us(pulses.stop), us(pulses.idle), us(pulses.full), us(pulses.high)));
  if (pulses.idle >= kMostIdle)
    return wrong(fmt::format("idle {:.1f} us is too near to 1460 us, where an ESC starts to calibrate",
                             us(pulses.idle)));
  return validate_period(pulses, period);
}

hal::Duration encode_pulse(hal::Duration pwm, EscProtocol protocol) {
  return protocol == EscProtocol::oneshot125 ? pwm / kOneshotShare : pwm;
}

hal::Duration pulse_of(double fraction, const EscPulses& pulses) {
  if (std::isnan(fraction)) return pulses.stop;
  if (fraction <= 0.0) return pulses.idle;
  if (fraction >= 1.0) return pulses.full;
  const auto travel = static_cast<double>((pulses.full - pulses.idle).count());
  return pulses.idle + hal::Duration(std::llround(fraction * travel));
}

}  // namespace forager::flight
