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

}  // namespace forager::boards
