#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/linux/modbus_bus.hpp"
#include "hal/usb_device.hpp"

// What the vendors' libraries and the kernel do by themselves, without this project's layer over them: the
// other side of a benchmark, and for nothing else. Written as their manuals show, every answer checked.
namespace forager::hal {

// Makes so many calls in a row and says what they did: their number, or bytes. Keeps what it needs open.
// Errors: those of the call.
using CallLoop = std::function<Result<std::uint64_t>(std::uint64_t calls)>;

// Sets an output active and inactive in turn. `chip` is a path. Errors: those of open_gpio_out.
[[nodiscard]] Result<CallLoop> open_bare_gpio(const std::string& chip, unsigned line);

// Writes the number of a register and reads from there, as one transfer: I2C_RDWR of i2c-dev.
struct BareI2cConfig {
  std::string device;  // "/dev/i2c-1"
  std::uint8_t address = 0;
  std::uint8_t first = 0;  // register
  std::size_t bytes = 1;   // to read
};
[[nodiscard]] Result<CallLoop> open_bare_i2c(const BareI2cConfig& config);

// Reads holding registers, from 0 on. Errors: those of Modbus.
[[nodiscard]] Result<CallLoop> open_bare_modbus(const ModbusRtuConfig& line, std::uint8_t unit,
                                                std::uint16_t registers);

// One blocking bulk transfer a call: libusb_bulk_transfer. Counts bytes of payload.
struct BareUsbConfig {
  UsbDeviceFacts device{};
  std::vector<std::uint8_t> interfaces{};  // to claim
  std::vector<UsbRequest> requests{};      // to send before, without data
  std::uint8_t endpoint = 0;
  std::size_t bytes = 4096;       // of one transfer
  std::size_t packet_bytes = 64;  // of which
  std::size_t status_bytes = 0;   // at the front of each are no payload
};
[[nodiscard]] Result<CallLoop> open_bare_usb(const BareUsbConfig& config);

}  // namespace forager::hal
