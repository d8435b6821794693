#pragma once

#include <memory>
#include <string>
#include <vector>

#include "boards/modbus_board.hpp"
#include "hal/error.hpp"
#include "hal/modbus.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// A Modbus line, serial or over TCP.
struct ModbusPlace {
  std::string bus;  // "/dev/ttyUSB0", HOST:PORT, or "sim": emulated in this process
  int baud = 19200;
  char parity = 'E';
  hal::Duration timeout = std::chrono::milliseconds(200);
};

// "sim" has one unit, number 1: holding registers 0 to 3 with 100, 200, 300, 400, input registers 0 and 1
// with 7 and 65535, coil 0. Errors: invalid_argument, unsupported (built without libmodbus); what else goes
// wrong shows when the line is used.
[[nodiscard]] hal::Result<std::unique_ptr<hal::Modbus>> open_modbus_bench(const ModbusPlace& place);

// A unit of a board file, with the line it is on; both belong to the board.
struct ModbusUnit {
  const ModbusLine* line;
  const ModbusDevice* device;
};
// By the device's name, or LINE.DEVICE where two lines have one of that name. Errors: invalid_argument,
// naming those there are.
[[nodiscard]] hal::Result<ModbusUnit> find_modbus(const std::vector<ModbusLine>& lines,
                                                  const std::string& text);

}  // namespace forager::boards
