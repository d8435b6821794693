#include "boards/modbus_bench.hpp"

#include "boards/board.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "mocks/fake_modbus.hpp"

namespace forager::boards {

hal::Result<std::unique_ptr<hal::Modbus>> open_modbus_bench(const ModbusPlace& place) {
  if (place.bus == "sim") {
    auto fake = std::make_unique<mocks::FakeModbus>(1);
    fake->holding = {{0, 100}, {1, 200}, {2, 300}, {3, 400}};
    fake->input = {{0, 7}, {1, 65535}};
    fake->coils = {{0, false}};
    return fake;
  }
  if (const auto endpoint = endpoint_from(place.bus))  // a serial port has no colon
    return hal::open_modbus_tcp({.host = endpoint->host, .port = endpoint->port, .timeout = place.timeout});
  return hal::open_modbus_rtu(
      {.device = place.bus, .baud = place.baud, .parity = place.parity, .timeout = place.timeout});
}

hal::Result<ModbusUnit> find_modbus(const std::vector<ModbusLine>& lines, const std::string& text) {
  std::string there;
  std::vector<ModbusUnit> found;
  for (const ModbusLine& line : lines)
    for (const ModbusDevice& device : line.devices) {
      const std::string full = line.name + "." + device.name;
      there += (there.empty() ? "" : ", ") + full;
      if (text == device.name || text == full) found.push_back({&line, &device});
    }
  if (found.size() == 1) return found.front();
  return hal::fail(
      hal::ErrorCode::invalid_argument, "modbus device '" + text + "'", "find",
      found.empty() ? "the board file names no such device" : "several lines have one of this name",
      there.empty() ? "Declare it: [[modbus]] and [[modbus.device]]" : "There are " + there);
}

}  // namespace forager::boards
