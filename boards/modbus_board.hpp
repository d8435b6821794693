#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/config_reader.hpp"
#include "hal/modbus.hpp"
#include "hal/serial.hpp"
#include "hal/time.hpp"
#include "servo/modbus_battery.hpp"
#include "servo/modbus_charger.hpp"
#include "servo/modbus_register.hpp"

namespace forager::boards {

enum class ModbusKind : std::uint8_t {
  registers,  // whatever the file declares
  battery,    // registers "voltage", "charge"; if it has them "current", "temperature"
  charger,    // register "status" with bits, coil "enable_coil"; if it has it "current"
};
[[nodiscard]] std::string_view to_string(ModbusKind kind);

// [[modbus.device]]: a unit on the line, and its manual.
struct ModbusDevice {
  std::string name;
  ModbusKind kind = ModbusKind::registers;
  std::uint8_t unit = 1;
  std::vector<servo::ModbusRegister> registers;
  std::uint16_t enable_coil = 0;  // charger
  std::uint8_t docked_bit = 0;    // charger, of "status"
  std::uint8_t charging_bit = 1;
  std::uint8_t fault_bit = 2;
  hal::Duration poll = std::chrono::seconds(1);
  hal::Duration stale = std::chrono::seconds(5);

  [[nodiscard]] const servo::ModbusRegister* find(std::string_view quantity) const;
};

// [[modbus]]: a line with devices on it.
struct ModbusLine {
  std::string name;
  std::string bus;  // a serial port, HOST:PORT, or "sim": emulated in this process
  hal::SerialSettings line{.baud = 19200, .data_bits = 8, .parity = hal::Parity::even};
  hal::Duration timeout = std::chrono::milliseconds(50);
  std::vector<ModbusDevice> devices;

  [[nodiscard]] const ModbusDevice* find(std::string_view device) const;
};

// Reads how a register lies and what it means, `address` to `unit`, over what the quantity says already;
// mistakes become the reader's issue.
void read_register_map(ConfigReader& table, servo::ModbusRegister& quantity);

// Reads every [[modbus]]; mistakes become the reader's issue.
[[nodiscard]] std::vector<ModbusLine> read_modbus_board(ConfigReader& top);

// The bus of a line; "sim" has a linear actuator (unit 3), a battery gauge (4) and a docking charger (5) on
// it, that live by `clock`, which must outlive the bus. Errors: those of hal::open_modbus_rtu().
[[nodiscard]] hal::Result<std::unique_ptr<hal::Modbus>> open_modbus(const ModbusLine& line,
                                                                    const hal::Clock& clock);

// The device's driver, borrowing the bus. Errors: invalid_argument (another kind, or a register is missing).
[[nodiscard]] hal::Result<servo::ModbusBattery> make_battery(hal::Modbus& bus, const ModbusDevice& device);
[[nodiscard]] hal::Result<servo::ModbusCharger> make_charger(hal::Modbus& bus, const ModbusDevice& device);

}  // namespace forager::boards
