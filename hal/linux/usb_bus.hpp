#pragma once

#include <memory>
#include <string>

#include "hal/linux/kernel.hpp"
#include "hal/time.hpp"
#include "hal/usb.hpp"

namespace forager::hal {

struct UsbBusConfig {
  // So long after a device was plugged in a missing permission means that udev has not come to it yet.
  Duration settle = std::chrono::seconds(2);
};

// The USB of this machine by libusb. What devices say of themselves, and which driver has them, is read from
// sysfs through `kernel`, which must outlive the bus. Errors: unsupported (built without libusb), io (the
// library does not start: no /dev/bus/usb in a container, for example).
[[nodiscard]] Result<std::unique_ptr<Usb>> open_usb_bus(const UsbBusConfig& config = {},
                                                        Kernel& kernel = real_kernel());

// "libusb 1.0.26", or "built without libusb".
[[nodiscard]] std::string usb_library();

}  // namespace forager::hal
