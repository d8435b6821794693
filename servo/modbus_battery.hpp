#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/time.hpp"
#include "servo/modbus_register.hpp"

namespace forager::servo {

struct ModbusBatteryConfig {
  std::uint8_t unit = 1;
  ModbusRegister voltage;                                 // V
  ModbusRegister charge;                                  // fraction, 0 empty to 1 full
  std::optional<ModbusRegister> current{};                // A, positive while it charges
  std::optional<ModbusRegister> temperature{};            // degrees Celsius
  hal::Duration poll_interval = std::chrono::seconds(1);  // of the whole set
  hal::Duration stale_after = std::chrono::seconds(5);
};

struct BatteryReading {
  double voltage_v = 0.0;
  double charge = 0.0;
  std::optional<double> current_a{};
  std::optional<double> temperature_c{};
  hal::Instant at;  // of the oldest of them
};

// A battery gauge on Modbus. An update() costs at most one exchange on the bus, so that a slow bus does not
// hold up the loop: a set of readings comes together over several updates.
class ModbusBattery {
 public:
  // Borrows the bus. Errors: invalid_argument (a register that cannot be, intervals not positive).
  [[nodiscard]] static hal::Result<ModbusBattery> create(hal::Modbus& bus, ModbusBatteryConfig config);

  // Errors: those of read(). After one the set is begun anew at the next interval, and the last one stays
  // until it is stale. A charge outside 0..1 by more than 0.05 is `protocol`: wrong scale or wrong register.
  [[nodiscard]] hal::Result<> update(hal::Instant now);

  // The last whole set; nothing before the first.
  [[nodiscard]] const std::optional<BatteryReading>& reading() const { return reading_; }
  // No set yet, or the last one is older than `stale_after`: whoever flies by it must not any more.
  [[nodiscard]] bool stale(hal::Instant now) const;
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  ModbusBattery(hal::Modbus& bus, ModbusBatteryConfig config);
  hal::Result<> take(std::size_t index, double value);

  hal::Modbus* bus_;
  ModbusBatteryConfig config_;
  std::string name_;
  std::size_t next_ = 0;  // of the four; the absent ones are stepped over
  BatteryReading coming_;
  std::optional<BatteryReading> reading_;
  std::optional<hal::Instant> next_set_;
};

}  // namespace forager::servo
