#include "hal/hid_facts.hpp"

#include <fmt/format.h>

namespace forager::hal {

bool fits(const HidMatch& match, const HidDeviceFacts& device) {
  return (!match.vendor || *match.vendor == device.vendor) &&
         (!match.product || *match.product == device.product) &&
         (match.serial.empty() || match.serial == device.serial) &&
         (match.path.empty() || match.path == device.path) &&
         (!match.usage_page || *match.usage_page == device.usage_page) &&
         (!match.usage || *match.usage == device.usage) &&
         (!match.interface_number || *match.interface_number == device.interface_number);
}

std::string describe(const HidDeviceFacts& device) {
  const std::string where = device.path.empty() ? "held by " + device.driver : "at " + device.path;
  return fmt::format("hid {:04x}:{:04x} {}", device.vendor, device.product, where);
}

std::string describe(const HidMatch& match) {
  const auto id = [](std::optional<std::uint16_t> value) {
    return value ? fmt::format("{:04x}", *value) : std::string("*");
  };
  std::string text = "hid";
  if (match.vendor || match.product) text += fmt::format(" {}:{}", id(match.vendor), id(match.product));
  if (match.usage_page || match.usage)
    text += fmt::format(" usage {}:{}", id(match.usage_page), id(match.usage));
  if (!match.serial.empty()) text += " serial " + match.serial;
  if (match.interface_number) text += fmt::format(" interface {}", *match.interface_number);
  if (!match.path.empty()) text += " at " + match.path;
  return text == "hid" ? "hid any device" : text;
}

}  // namespace forager::hal
