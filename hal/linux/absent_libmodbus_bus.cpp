#include "hal/linux/modbus_bus.hpp"

namespace forager::hal {
namespace {

Failure absent(std::string device) {
  return fail(ErrorCode::unsupported, std::move(device), "open", "built without libmodbus",
              "Install libmodbus-dev and build again with -DFORAGER_WITH_MODBUS=ON");
}

}  // namespace

Result<std::unique_ptr<Modbus>> open_modbus_rtu(const ModbusRtuConfig& config) {
  return absent("modbus " + config.device);
}
Result<std::unique_ptr<Modbus>> open_modbus_tcp(const ModbusTcpConfig& config) {
  return absent("modbus " + config.host);
}
std::string modbus_library() { return "built without libmodbus"; }

}  // namespace forager::hal
