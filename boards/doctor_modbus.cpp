// Modbus devices of a board file: each is asked for one register.
#include <fmt/format.h>

#include "boards/bench_devices.hpp"
#include "boards/doctor.hpp"
#include "boards/modbus_board.hpp"
#include "hal/linux/modbus_bus.hpp"

namespace forager::boards {
namespace {

constexpr std::string_view kArea = "board";

void check_actuator(const Doctor& doctor, const std::string& name, const BrakeLine& line) {
  const auto endpoint = endpoint_from(line.bus);
  const auto bus =
      endpoint
          ? hal::open_modbus_tcp({.host = endpoint->host, .port = endpoint->port, .timeout = line.timeout})
          : hal::open_modbus_rtu(
                {.device = line.bus, .baud = line.baud, .parity = line.parity, .timeout = line.timeout});
  if (!bus) return doctor.fail(kArea, name, bus.error());
  const servo::ModbusBrakeConfig& actuator = line.actuator;
  const auto position = servo::read(**bus, actuator.unit, actuator.measured.value_or(actuator.target));
  if (!position) return doctor.fail(kArea, name, position.error());
  doctor.ok(kArea, name, fmt::format("unit {} on {} answers, {:g}", actuator.unit, line.bus, *position));
}

void check_device(const Doctor& doctor, hal::Modbus& bus, const ModbusDevice& device) {
  const std::string name = "modbus " + device.name;
  if (device.registers.empty())
    return doctor.skip(kArea, name, "the board file declares no register to ask for");
  const servo::ModbusRegister& first = device.registers.front();
  const auto value = servo::read(bus, device.unit, first);
  if (!value) return doctor.fail(kArea, name, value.error());
  doctor.ok(kArea, name, fmt::format("unit {} answers, {} is {:g}", device.unit, first.name, *value));
}

void check_modbus_line(const Doctor& doctor, const ModbusLine& line) {
  if (line.bus == "sim") return doctor.skip(kArea, "modbus " + line.name, "emulated in this process");
  const auto bus = open_modbus(line, doctor.machine.clock());
  if (!bus) return doctor.fail(kArea, "modbus " + line.name, bus.error());
  for (const ModbusDevice& device : line.devices) check_device(doctor, **bus, device);
}

}  // namespace

void check_actuators(const Doctor& doctor, const Board& board) {
  for (const ModbusLine& line : board.modbus) check_modbus_line(doctor, line);
  if (!board.brakes.named) return;
  if (board.brakes.left.backend == BrakeBackend::modbus)
    check_actuator(doctor, "modbus brakes.left", board.brakes.left);
  if (board.brakes.right.backend == BrakeBackend::modbus)
    check_actuator(doctor, "modbus brakes.right", board.brakes.right);
}

}  // namespace forager::boards
