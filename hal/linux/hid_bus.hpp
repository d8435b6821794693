#pragma once

#include <memory>
#include <string>

#include "hal/hid.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {

// The HID devices of this machine by hidapi over the kernel's hidraw. `kernel`, which must outlive the bus,
// tells from sysfs which driver has a device (so that one that leaves no hidraw is listed, without a path),
// and takes keyboards away from the console: HidSharing::exclusive grabs every input device that the kernel
// made of the HID device (EVIOCGRAB). A device without input devices, such as an MCP2221A, is exclusive only
// by agreement: hidraw itself can be opened by several programs.
// Errors: unsupported (built without hidapi), io.
[[nodiscard]] Result<std::unique_ptr<Hid>> open_hid_bus(Kernel& kernel = real_kernel());

// "hidapi 0.13.1", or "built without hidapi".
[[nodiscard]] std::string hid_library();

}  // namespace forager::hal
