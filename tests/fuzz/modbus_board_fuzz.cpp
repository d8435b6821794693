// Any bytes given as the Modbus lines of a board file end in lines or in one error line, never in a crash;
// what was accepted can be made and asked: every register is one, and every device has what its kind needs.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "boards/modbus_board.hpp"
#include "mocks/fake_modbus.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace forager;
  const auto node =
      boards::parse_config(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.toml");
  if (!node) return describe(node.error()).empty() ? std::abort(), 0 : 0;
  boards::ConfigIssue issue;
  boards::ConfigReader top(&*node, "", issue);
  const auto lines = boards::read_modbus_board(top);
  check_unused(*node, issue);
  if (issue) return describe(*issue).empty() ? std::abort(), 0 : 0;
  for (const boards::ModbusLine& line : lines) {
    if (!hal::check(line.line, line.name)) std::abort();
    for (const boards::ModbusDevice& device : line.devices) {
      mocks::FakeModbus bus(device.unit);
      for (const servo::ModbusRegister& quantity : device.registers) {
        if (!servo::check(quantity)) std::abort();
        static_cast<void>(servo::read(bus, device.unit, quantity));
        static_cast<void>(servo::encode(quantity, 1.0));
      }
      if (device.kind == boards::ModbusKind::battery && !make_battery(bus, device)) std::abort();
      if (device.kind == boards::ModbusKind::charger && !make_charger(bus, device)) std::abort();
    }
  }
  return 0;
}
