#include "mocks/sim_pca9685.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "servo/pca9685_wire.hpp"

namespace forager::mocks {

using namespace servo::pca9685;

namespace {

constexpr hal::Duration kStartUp = std::chrono::microseconds(kOscillatorWakeUs);
constexpr std::uint8_t kOnHigh = 1;  // registers of a channel after ON_L
constexpr std::uint8_t kOffLow = 2;
constexpr std::uint8_t kOffHigh = 3;

}  // namespace

SimPca9685::SimPca9685(double oscillator_hz) : oscillator_hz_(oscillator_hz) { power_cycle(); }

void SimPca9685::power_cycle() {
  registers_.fill(0);
  registers_[kMode1] = kMode1Reset;
  registers_[kMode2] = kMode2Reset;
  registers_[kSubAdr1] = 0xE2;
  registers_[kSubAdr1 + 1] = 0xE4;
  registers_[kSubAdr1 + 2] = 0xE8;
  registers_[kAllCallAdr] = 0xE0;
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    registers_[kLed0 + 4 * channel + kOffHigh] = kFull;
  registers_[kPreScale] = kPreScaleReset;
  pointer_ = 0;
  stopped_ = false;
}

bool SimPca9685::known(std::uint8_t address) {
  return address <= kLedLast || (address >= kAllLed && address <= kPreScale);
}

bool SimPca9685::asleep() const { return (registers_[kMode1] & kSleep) != 0; }

bool SimPca9685::oscillator_runs() const { return !asleep() && now_ - woken_at_ >= kStartUp; }

bool SimPca9685::violation(std::string what) {
  violations_.push_back(std::move(what));
  return false;
}

bool SimPca9685::write(std::byte byte) {
  const auto value = std::to_integer<std::uint8_t>(byte);
  if (first_) {
    first_ = false;
    if (!known(value)) return violation(fmt::format("register 0x{:02x} is reserved", value));
    pointer_ = value;
    return true;
  }
  if (!known(pointer_)) return violation(fmt::format("a burst runs on into 0x{:02x}", pointer_));
  if (!store(pointer_, value)) return false;
  next_register();
  return true;
}

std::optional<std::byte> SimPca9685::read() {
  if (!known(pointer_)) {
    violation(fmt::format("a burst reads on into 0x{:02x}", pointer_));
    return std::nullopt;
  }
  // ALL_LED registers are write-only and read as zero (table 4).
  const std::uint8_t value = pointer_ >= kAllLed && pointer_ <= kAllLedLast ? 0 : registers_[pointer_];
  next_register();
  return std::byte{value};
}

// Section 7.3.1.2 and table 4: the pointer moves only with auto-increment, and after LED15_OFF_H comes MODE1.
void SimPca9685::next_register() {
  if ((registers_[kMode1] & kAutoIncrement) == 0) return;
  pointer_ = pointer_ == kLedLast ? kMode1 : static_cast<std::uint8_t>(pointer_ + 1);
}

void SimPca9685::store_mode1(std::uint8_t value) {
  const bool slept = asleep();
  const bool sleeps = (value & kSleep) != 0;
  std::uint8_t restart = registers_[kMode1] & kRestart;
  const bool pulsing = std::any_of(registers_.begin() + kLed0, registers_.begin() + kLedLast + 1,
                                   [index = 0](std::uint8_t off_high) mutable {
                                     return index++ % 4 == kOffHigh && (off_high & kFull) == 0;
                                   });
  if (!slept && sleeps && pulsing) {  // section 7.3.1.1: RESTART tells that channels were cut off
    restart = kRestart;
    stopped_ = true;
  }
  if (slept && !sleeps) woken_at_ = now_;
  if ((value & kRestart) != 0 && restart != 0 && !sleeps) {
    restart = 0;
    stopped_ = false;
    if (now_ - woken_at_ < kStartUp) violation("RESTART before the oscillator has run for 500 us");
  }
  registers_[kMode1] = static_cast<std::uint8_t>((value & ~kRestart) | restart);
}

bool SimPca9685::store(std::uint8_t address, std::uint8_t value) {
  if (address == kMode1) {
    if ((value & kExtClk) != 0) return violation("EXTCLK: no clock is wired to this chip");
    store_mode1(value);
    return true;
  }
  if (address == kPreScale) {
    if (!asleep()) return violation("PRE_SCALE is blocked while the oscillator runs");
    if (value < kPreScaleMin) return violation(fmt::format("PRE_SCALE {} is below 3", value));
    registers_[address] = value;
    return true;
  }
  if (address == kMode2 && (value & 0xE0) != 0) return violation("reserved bits of MODE2");
  const bool high = (address >= kLed0 && address <= kLedLast && (address - kLed0) % 2 == 1) ||
                    address == kAllLed + kOnHigh || address == kAllLed + kOffHigh;
  if (high && (value & 0xE0) != 0)
    return violation(fmt::format("reserved bits of register 0x{:02x}", address));
  if (address >= kLed0 && !asleep() && !oscillator_runs())
    violation(fmt::format("register 0x{:02x} before the oscillator has run for 500 us", address));
  if (address >= kAllLed) {
    for (std::size_t channel = 0; channel < kChannels; ++channel)
      registers_[kLed0 + 4 * channel + address - kAllLed] = value;
    return true;
  }
  registers_[address] = value;
  return true;
}

hal::Duration SimPca9685::period() const {
  return hal::Duration(std::llround((registers_[kPreScale] + 1.0) * kSteps / oscillator_hz_ * 1e9));
}

std::optional<hal::Duration> SimPca9685::pulse(std::size_t channel) const {
  if (!enabled_ || !oscillator_runs() || stopped_) return std::nullopt;
  const std::uint8_t* led = &registers_[kLed0 + 4 * channel];
  if ((led[kOffHigh] & kFull) != 0) return std::nullopt;
  if ((led[kOnHigh] & kFull) != 0) return period();
  const int on = led[0] | (led[kOnHigh] & 0x0F) << 8;
  const int off = led[kOffLow] | (led[kOffHigh] & 0x0F) << 8;
  const int high = (off - on + kSteps) % kSteps;
  return hal::Duration(std::llround(high * static_cast<double>(period().count()) / kSteps));
}

}  // namespace forager::mocks
