#include "boards/board.hpp"
#include "boards/modbus_board.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "mocks/sim_battery_gauge.hpp"
#include "mocks/sim_docking_charger.hpp"
#include "mocks/sim_linear_actuator.hpp"
#include "mocks/sim_modbus_bus.hpp"

namespace forager::boards {
namespace {

// A bench of devices in this process. They live up to the moment they are asked.
class EmulatedLine final : public hal::Modbus {
 public:
  explicit EmulatedLine(const hal::Clock& clock) : clock_(&clock) {
    for (mocks::SimModbusSlave* slave : {&actuator_.slave(), &gauge_.slave(), &dock_.slave()})
      bus_.attach(*slave);
    dock_.docked = true;
  }

 private:
  mocks::SimModbusBus& now() {
    const hal::Instant at = clock_->now();
    actuator_.update(at);
    dock_.update(at);
    gauge_.current_a = dock_.live() ? dock_.current_a() : -1.5;
    gauge_.update(at);
    return bus_;
  }
  hal::Result<> do_read(Table table, std::uint8_t unit, std::uint16_t address,
                        std::span<std::uint16_t> into) override {
    return table == Table::holding ? now().read_holding(unit, address, into)
                                   : now().read_input(unit, address, into);
  }
  hal::Result<> do_write(std::uint8_t unit, std::uint16_t address,
                         std::span<const std::uint16_t> values) override {
    return now().write_holding(unit, address, values);
  }
  hal::Result<> do_write_coil(std::uint8_t unit, std::uint16_t address, bool on) override {
    return now().write_coil(unit, address, on);
  }
  [[nodiscard]] std::string_view do_name() const override { return bus_.name(); }

  const hal::Clock* clock_;
  mocks::SimModbusBus bus_;
  mocks::SimLinearActuator actuator_;
  mocks::SimBatteryGauge gauge_;
  mocks::SimDockingCharger dock_;
};

char letter_of(hal::Parity parity) {
  return parity == hal::Parity::none ? 'N' : parity == hal::Parity::even ? 'E' : 'O';
}

}  // namespace

hal::Result<std::unique_ptr<hal::Modbus>> open_modbus(const ModbusLine& line, const hal::Clock& clock) {
  if (line.bus == "sim") return std::make_unique<EmulatedLine>(clock);
  if (const auto endpoint = endpoint_from(line.bus))  // a serial port has no colon
    return hal::open_modbus_tcp({.host = endpoint->host, .port = endpoint->port, .timeout = line.timeout});
  return hal::open_modbus_rtu({.device = line.bus,
                               .baud = static_cast<int>(line.line.baud),
                               .parity = letter_of(line.line.parity),
                               .stop_bits = line.line.stop_bits,
                               .timeout = line.timeout});
}

}  // namespace forager::boards
