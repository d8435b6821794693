#include "hal/linux/bare_calls.hpp"

namespace forager::hal {

Result<CallLoop> open_bare_usb(const BareUsbConfig& config) {
  return fail(ErrorCode::unsupported, describe(config.device), "open", "built without libusb",
              "Install libusb-1.0-0-dev and build again with -DFORAGER_WITH_LIBUSB=ON");
}

}  // namespace forager::hal
