#pragma once

#include <cstdint>
#include <optional>

#include "hal/time.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::mocks {

// A dock with open contacts and a charger behind them. It closes its contactor a moment after it was enabled
// while the robot stands in it, opens at once when the robot leaves, and latches a fault when it was enabled
// with nobody there: bare contacts under voltage are what it must never allow.
class SimDockingCharger {
 public:
  static constexpr std::uint16_t kStatus = 0;   // input: bits below
  static constexpr std::uint16_t kCurrent = 1;  // input, u16, 0.01 A
  static constexpr std::uint16_t kEnable = 0;   // coil
  static constexpr std::uint16_t kClear = 1;    // coil: takes the fault back
  static constexpr std::uint16_t kDockedBit = 0;
  static constexpr std::uint16_t kChargingBit = 1;
  static constexpr std::uint16_t kFaultBit = 2;

  struct Options {
    std::uint8_t unit = 5;
    double current_a = 5.0;
    hal::Duration closing = std::chrono::milliseconds(300);
  };

  SimDockingCharger() : SimDockingCharger(Options{}) {}
  explicit SimDockingCharger(const Options& options);

  SimModbusSlave& slave() { return slave_; }
  void update(hal::Instant now);

  // The physical face.
  bool docked = false;
  [[nodiscard]] bool live() const { return live_; }  // voltage on the contacts
  [[nodiscard]] double current_a() const { return live_ ? options_.current_a : 0.0; }

 private:
  Options options_;
  SimModbusSlave slave_;
  std::optional<hal::Instant> enabled_since_;
  bool was_enabled_ = false;
  bool live_ = false;
  bool fault_ = false;
};

}  // namespace forager::mocks
