#pragma once

#include <cstdint>
#include <optional>

#include "hal/time.hpp"
#include "mocks/sim_modbus_slave.hpp"

namespace forager::mocks {

// A battery of lithium cells with a gauge on Modbus that counts what flows. Its registers have one of each
// kind that gauges use: scaled, signed, wide with the low word first, and a float.
class SimBatteryGauge {
 public:
  static constexpr std::uint16_t kVoltage = 0;      // input, u16, 0.01 V
  static constexpr std::uint16_t kCurrent = 1;      // input, i16, 0.1 A, positive while it charges
  static constexpr std::uint16_t kTemperature = 2;  // input, i16, 0.1 K above 0 degrees Celsius
  static constexpr std::uint16_t kCharge = 10;      // input, f32 high word first, percent
  static constexpr std::uint16_t kCapacity = 20;    // holding, u32 low word first, mAh

  struct Options {
    std::uint8_t unit = 4;
    double capacity_ah = 10.0;
    double charge = 0.8;  // fraction
    double empty_v = 18.0;
    double full_v = 25.2;
    double resistance_ohm = 0.02;
  };

  SimBatteryGauge() : SimBatteryGauge(Options{}) {}
  explicit SimBatteryGauge(const Options& options);

  SimModbusSlave& slave() { return slave_; }
  void update(hal::Instant now);

  // The physical face.
  double current_a = 0.0;  // into the battery
  double temperature_c = 20.0;
  [[nodiscard]] double charge() const { return charge_; }
  [[nodiscard]] double voltage_v() const;

 private:
  void show();

  Options options_;
  SimModbusSlave slave_;
  double charge_;
  std::optional<hal::Instant> last_;
};

}  // namespace forager::mocks
