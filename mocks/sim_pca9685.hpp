#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "mocks/sim_i2c_bus.hpp"

namespace forager::mocks {

// A PCA9685 (NXP data sheet rev. 4): the registers of table 4 with their resets and rights, auto-increment,
// sleep and restart, oscillator start-up, output enable. What the data sheet reserves is not acknowledged,
// and every such access is kept in violations() for the test to look at. So is what a real chip would
// silently ignore or answer with undefined timing: PRE_SCALE written awake, outputs changed before the
// oscillator runs.
class SimPca9685 final : public SimI2cDevice {
 public:
  explicit SimPca9685(double oscillator_hz = 25e6);

  // The physical face. Time for the oscillator's start; the OE pin (low enables).
  void advance(hal::Instant now) { now_ = now; }
  void drive_output_enable(bool enabled) { enabled_ = enabled; }
  // Supply gone and back: every register at its reset value.
  void power_cycle();

  // The active part of the period at an output; nothing: no pulses (off, asleep, disabled).
  [[nodiscard]] std::optional<hal::Duration> pulse(std::size_t channel) const;
  [[nodiscard]] hal::Duration period() const;
  [[nodiscard]] std::uint8_t reg(std::uint8_t address) const { return registers_[address]; }
  [[nodiscard]] const std::vector<std::string>& violations() const { return violations_; }

 private:
  void start() override { first_ = true; }
  bool write(std::byte byte) override;
  std::optional<std::byte> read() override;

  [[nodiscard]] static bool known(std::uint8_t address);
  bool store(std::uint8_t address, std::uint8_t value);
  void store_mode1(std::uint8_t value);
  void next_register();
  [[nodiscard]] bool asleep() const;
  [[nodiscard]] bool oscillator_runs() const;
  bool violation(std::string what);

  double oscillator_hz_;
  std::array<std::uint8_t, 256> registers_{};
  std::uint8_t pointer_ = 0;
  bool first_ = true;  // the next byte written is the register's address
  bool enabled_ = true;
  bool stopped_ = false;  // by a sleep; only RESTART lets the outputs go on
  hal::Instant now_;
  hal::Instant woken_at_;
  std::vector<std::string> violations_;
};

}  // namespace forager::mocks
