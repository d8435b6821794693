#pragma once

#include <libusb.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/usb_device.hpp"

// The opaque types of libusb as this test program has them, and what its two files share.

struct libusb_context {
  int unused = 0;
};
struct libusb_device {
  explicit libusb_device(forager::hal::UsbDeviceFacts what) : facts(std::move(what)) {}
  forager::hal::UsbDeviceFacts facts;
  int references = 1;
  std::vector<std::vector<libusb_endpoint_descriptor>> endpoints;
  std::vector<libusb_interface_descriptor> settings;
  std::vector<libusb_interface> interfaces;
  libusb_config_descriptor config{};
};
struct libusb_device_handle {
  std::unique_ptr<forager::hal::UsbDevice> device;
  std::string path;
};

namespace forager::hal::fake {

// LIBUSB_ERROR_ of an error.
[[nodiscard]] int libusb_error_of(const Error& error);
// The device of this path, made when it is asked for first; forgotten when it leaves.
[[nodiscard]] libusb_device* libusb_device_at(const UsbDeviceFacts& facts);
void forget_libusb_device(const std::string& path);
void forget_libusb_devices();
[[nodiscard]] bool libusb_plugged(const std::string& path);
void forget_libusb_transfers();

}  // namespace forager::hal::fake
