#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/modbus.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct ModbusRtuConfig {
  std::string device;  // "/dev/ttyUSB0", better "/dev/serial/by-id/..."
  int baud = 19200;
  char parity = 'E';  // N, E, O
  int stop_bits = 1;
  Duration timeout = std::chrono::milliseconds(50);  // from the question to the first byte of the answer
};
struct ModbusTcpConfig {
  std::string host;  // numeric address
  std::uint16_t port = 502;
  Duration timeout = std::chrono::milliseconds(50);  // of connecting, and of an answer
};

// By libmodbus. Nothing is opened before the first call, and a lost line is opened again by the next one.
// Errors: invalid_argument (impossible settings), unsupported (built without libmodbus).
[[nodiscard]] Result<std::unique_ptr<Modbus>> open_modbus_rtu(const ModbusRtuConfig& config);
[[nodiscard]] Result<std::unique_ptr<Modbus>> open_modbus_tcp(const ModbusTcpConfig& config);

// "libmodbus 3.1.6", or "built without libmodbus".
[[nodiscard]] std::string modbus_library();

}  // namespace forager::hal
