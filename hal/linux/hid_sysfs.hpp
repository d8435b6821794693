#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/hid_facts.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {

// A HID device as the kernel's HID core knows it.
struct HidNode {
  std::string folder;    // "/sys/bus/hid/devices/0003:04D8:00DD.0001"
  HidDeviceFacts facts;  // path empty: its driver leaves no hidraw; usage and interface unknown
};

// Needs neither hidapi nor a permission.
[[nodiscard]] std::vector<HidNode> list_hid_nodes(Kernel& kernel);

// Linux 6.1's hid-mcp2221 takes an MCP2221A without leaving a hidraw: then its pins are those of a gpiochip
// and its bus an i2c adapter of the kernel, and this program cannot open it as "mcp2221". The error says
// which, and what to do about it; nothing: the kernel's driver has none. For `forager doctor` and whoever
// finds no device.
[[nodiscard]] std::optional<Error> mcp2221_held_by_kernel(Kernel& kernel = real_kernel());

// Takes every input device that the kernel made of a HID device for this program alone (EVIOCGRAB), so that a
// keyboard types nowhere else. Files to keep open for as long; empty: the kernel made none of it. Errors:
// busy (another program has done so), permission (not in the group input), unsupported (a kernel without
// event devices), disconnected, io.
[[nodiscard]] Result<std::vector<int>> grab_inputs(Kernel& kernel, const HidDeviceFacts& device);

// Why /dev/hidrawN could not be opened.
[[nodiscard]] Failure hid_open_failure(std::string device, int error);

}  // namespace forager::hal
