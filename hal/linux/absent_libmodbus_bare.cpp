#include "hal/linux/bare_calls.hpp"

namespace forager::hal {

Result<CallLoop> open_bare_modbus(const ModbusRtuConfig& line, std::uint8_t, std::uint16_t) {
  return fail(ErrorCode::unsupported, "modbus " + line.device, "open", "built without libmodbus",
              "Install libmodbus-dev and build again with -DFORAGER_WITH_MODBUS=ON");
}

}  // namespace forager::hal
