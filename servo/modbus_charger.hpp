#pragma once

#include <optional>
#include <string>

#include "hal/halt.hpp"
#include "hal/time.hpp"
#include "servo/modbus_register.hpp"

namespace forager::servo {

struct ModbusChargerConfig {
  std::uint8_t unit = 1;
  ModbusRegister status;          // u16 with the bits below
  std::uint8_t docked_bit = 0;    // the robot's contacts touch
  std::uint8_t charging_bit = 1;  // current flows
  std::uint8_t fault_bit = 2;
  std::uint16_t enable_coil = 0;            // on: the contactor may close
  std::optional<ModbusRegister> current{};  // A
  hal::Duration poll_interval = std::chrono::milliseconds(200);
  hal::Duration stale_after = std::chrono::seconds(1);
};

struct ChargerReading {
  bool docked = false;
  bool charging = false;
  bool fault = false;
  std::optional<double> current_a{};
  hal::Instant at;
};

// A docking charger on Modbus. The contacts of a dock are open to the air, so they carry voltage only while
// somebody asks for it, the charger says that the robot is there, and it reports no fault: otherwise the coil
// is off. Safe state: off.
//
// An update() costs at most two exchanges: one question, and one write when the coil must change. After an
// error of the write the coil is written again, whatever is wanted then.
class ModbusCharger final : public hal::Halt {
 public:
  // Borrows the bus. Errors: invalid_argument (a register that cannot be, a bit above 15, intervals).
  [[nodiscard]] static hal::Result<ModbusCharger> create(hal::Modbus& bus, ModbusChargerConfig config);

  // Charging is wanted until then; say it again and again.
  void charge_until(hal::Instant valid_until) { wanted_until_ = valid_until; }
  void stop() { wanted_until_.reset(); }
  void halt() noexcept override;

  // Errors: those of read() and of hal::Modbus::write_coil().
  [[nodiscard]] hal::Result<> update(hal::Instant now);

  [[nodiscard]] const std::optional<ChargerReading>& reading() const { return reading_; }
  [[nodiscard]] bool stale(hal::Instant now) const;
  // What the coil was told last; nothing when that is not known.
  [[nodiscard]] std::optional<bool> enabled() const { return enabled_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  ModbusCharger(hal::Modbus& bus, ModbusChargerConfig config);
  hal::Result<> ask(hal::Instant now);
  hal::Result<> enable(bool on);

  hal::Modbus* bus_;
  ModbusChargerConfig config_;
  std::string name_;
  bool current_next_ = false;
  std::optional<hal::Instant> next_poll_;
  std::optional<hal::Instant> wanted_until_;
  std::optional<ChargerReading> reading_;
  std::optional<bool> enabled_;
};

}  // namespace forager::servo
