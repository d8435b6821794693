#pragma once

#include <string>

#include "hal/linux/kernel.hpp"

namespace forager::hal {

// A device file without symbolic links: "/dev/serial/by-id/usb-FTDI..." is "/dev/ttyUSB0". A name that is no
// link stays as it is.
[[nodiscard]] std::string real_device(Kernel& kernel, std::string path);

// Who has a device file open: "process 812 (ModemManager)", from /proc, this one included. Empty if nobody is
// seen; processes of other users are seen by root only.
[[nodiscard]] std::string holder_of(Kernel& kernel, const std::string& path);

}  // namespace forager::hal
