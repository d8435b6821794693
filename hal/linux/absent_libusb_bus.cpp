#include "hal/linux/usb_bus.hpp"

namespace forager::hal {

Result<std::unique_ptr<Usb>> open_usb_bus(const UsbBusConfig&, Kernel&) {
  return fail(ErrorCode::unsupported, "usb", "open", "built without libusb",
              "Install libusb-1.0-0-dev and build again with -DFORAGER_WITH_LIBUSB=ON");
}

std::string usb_library() { return "built without libusb"; }

}  // namespace forager::hal
