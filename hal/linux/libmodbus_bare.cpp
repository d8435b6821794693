// libmodbus 3.1. Twin: absent_libmodbus_bare.cpp.
#include <modbus/modbus.h>

#include <cerrno>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {
namespace {

struct Line {
  explicit Line(modbus_t* made) : context(made) {}
  ~Line() {
    modbus_close(context);
    modbus_free(context);
  }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;
  modbus_t* context;
};

}  // namespace

Result<CallLoop> open_bare_modbus(const ModbusRtuConfig& line, std::uint8_t unit, std::uint16_t registers) {
  const auto failed = [name = "modbus " + line.device](const char* operation, int error) {
    return fail(code_of_device_errno(error), name, operation, modbus_strerror(error));
  };
  modbus_t* const made = modbus_new_rtu(line.device.c_str(), line.baud, line.parity, 8, line.stop_bits);
  if (made == nullptr) return failed("open", errno);
  const auto open = std::make_shared<Line>(made);
  const auto us = static_cast<std::uint32_t>(line.timeout / std::chrono::microseconds(1));
  if (modbus_set_slave(made, unit) != 0 ||
      modbus_set_response_timeout(made, us / 1'000'000, us % 1'000'000) != 0 || modbus_connect(made) != 0)
    return failed("open", errno);
  std::vector<std::uint16_t> into(registers);
  const auto run = [open, into, failed](std::uint64_t calls) mutable -> Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i)
      if (modbus_read_registers(open->context, 0, static_cast<int>(into.size()), into.data()) < 0)
        return failed("read registers", errno);
    return calls;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
