#pragma once

#include <memory>

#include "hal/usb_device.hpp"

struct libusb_context;
struct libusb_device_handle;

namespace forager::hal {

// An open device of libusb; takes the handle. The context must outlive it.
[[nodiscard]] std::unique_ptr<UsbDevice> make_libusb_device(std::shared_ptr<libusb_context> context,
                                                            libusb_device_handle* handle,
                                                            UsbDeviceFacts facts);

}  // namespace forager::hal
