#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace forager::hal {

struct HidDeviceFacts {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial{};  // empty: it has none
  std::string manufacturer{};
  std::string product_name{};
  std::string path{};            // "/dev/hidraw0"; empty: a driver of the kernel has it and leaves no way in
  std::uint16_t usage_page = 0;  // of its first collection: 0x0001, 0x0006 is a keyboard; 0: unknown
  std::uint16_t usage = 0;
  int interface_number = -1;  // of USB; -1: none or unknown
  std::string driver{};       // of the kernel: "hid-generic", "mcp2221"; empty: unknown
};

// Which device is meant; what is empty fits every device.
struct HidMatch {
  std::optional<std::uint16_t> vendor{};
  std::optional<std::uint16_t> product{};
  std::string serial{};
  std::string path{};
  std::optional<std::uint16_t> usage_page{};
  std::optional<std::uint16_t> usage{};
  std::optional<int> interface_number{};
};

[[nodiscard]] bool fits(const HidMatch& match, const HidDeviceFacts& device);
// "hid 04d8:00dd at /dev/hidraw0"; "hid 04d8:00dd held by mcp2221".
[[nodiscard]] std::string describe(const HidDeviceFacts& device);
// "hid 04d8:00dd serial SN5"; "hid any device".
[[nodiscard]] std::string describe(const HidMatch& match);

}  // namespace forager::hal
