#include "flight/dshot.hpp"

#include <cmath>

namespace forager::flight {
namespace {

constexpr int kRepeats = 10;     // firmware wants 6 to 10
constexpr int kBeepRepeats = 1;  // a beep is no setting

bool is_beep(DshotCommand command) {
  return command >= DshotCommand::beep1 && command <= DshotCommand::beep5;
}

}  // namespace

DshotBitTimes dshot_bit_times(DshotRate rate) {
  // kbit/s: a bit lasts 1e6 / rate ns. Rounded once, from the exact fraction.
  const double bit_ns = 1e6 / static_cast<double>(static_cast<std::uint16_t>(rate));
  const auto ns = [](double value) { return hal::Duration(std::llround(value)); };
  return {ns(bit_ns), ns(0.75 * bit_ns), ns(0.375 * bit_ns)};
}

hal::Duration dshot_frame_time(DshotRate rate) {
  return hal::Duration(std::llround(16e6 / static_cast<double>(static_cast<std::uint16_t>(rate))));
}

hal::Result<std::uint16_t> DshotEncoder::throttle(double fraction, bool telemetry) {
  if (!(fraction >= 0.0 && fraction <= 1.0))
    return hal::fail(hal::ErrorCode::invalid_argument, "DShot", "encode throttle",
                     std::to_string(fraction) + " is not in 0..1");
  running_ = fraction > 0.0;
  if (!running_) return dshot_word(kDshotStop, telemetry, kind_);
  const double steps = kDshotLastThrottle - kDshotFirstThrottle;
  const auto value = static_cast<std::uint16_t>(kDshotFirstThrottle + std::lround(fraction * steps));
  return dshot_word(value, telemetry, kind_);
}

hal::Result<DshotBurst> DshotEncoder::command(DshotCommand command) const {
  if (running_)
    return hal::fail(hal::ErrorCode::invalid_state, "DShot",
                     "encode command " + std::to_string(static_cast<int>(command)), "the motor runs",
                     "stop it first");
  // Commands are taken with the telemetry bit set only: without it some firmware reads a throttle.
  return DshotBurst{dshot_word(static_cast<std::uint16_t>(command), true, kind_),
                    is_beep(command) ? kBeepRepeats : kRepeats};
}

}  // namespace forager::flight
