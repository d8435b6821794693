#include "hal/usb_facts.hpp"

#include <fmt/format.h>

namespace forager::hal {

bool fits(const UsbMatch& match, const UsbDeviceFacts& device) {
  return (!match.vendor || *match.vendor == device.vendor) &&
         (!match.product || *match.product == device.product) &&
         (match.serial.empty() || match.serial == device.serial) &&
         (match.path.empty() || match.path == device.path);
}

std::string describe(const UsbDeviceFacts& device) {
  return fmt::format("usb {:04x}:{:04x} at {}", device.vendor, device.product, device.path);
}

std::string describe(const UsbMatch& match) {
  const auto id = [](std::optional<std::uint16_t> value) {
    return value ? fmt::format("{:04x}", *value) : std::string("*");
  };
  std::string text =
      match.vendor || match.product ? fmt::format("usb {}:{}", id(match.vendor), id(match.product)) : "usb";
  if (!match.serial.empty()) text += " serial " + match.serial;
  if (!match.path.empty()) text += " at " + match.path;
  return text == "usb" ? "usb any device" : text;
}

}  // namespace forager::hal
