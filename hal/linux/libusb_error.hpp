#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// The Failure of a LIBUSB_ERROR_ number.
[[nodiscard]] Failure libusb_failure(std::string_view device, std::string operation, int error);
// The LIBUSB_ERROR_ number that says the same as a LIBUSB_TRANSFER_ number, not that of success.
[[nodiscard]] int libusb_error_of_transfer(int status);
// Rounded up to whole milliseconds, at least one: zero means for ever to libusb.
[[nodiscard]] unsigned libusb_milliseconds(Duration at_most);

}  // namespace forager::hal
