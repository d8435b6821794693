// libusb 1.0. Twin: absent_libusb_bare.cpp.
#include <libusb.h>

#include <algorithm>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/libusb_error.hpp"

namespace forager::hal {
namespace {

constexpr unsigned kTimeoutMs = 1000;

struct Session {
  ~Session() {
    for (const std::uint8_t interface : claimed) libusb_release_interface(handle, interface);
    if (handle != nullptr) libusb_close(handle);
    if (context != nullptr) libusb_exit(context);
  }
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  libusb_context* context = nullptr;
  libusb_device_handle* handle = nullptr;
  std::vector<std::uint8_t> claimed;
};

// 0, or a LIBUSB_ERROR_.
int open(Session& session, const BareUsbConfig& config) {
  if (const int error = libusb_init(&session.context); error < 0) return error;
  session.handle =
      libusb_open_device_with_vid_pid(session.context, config.device.vendor, config.device.product);
  if (session.handle == nullptr) return LIBUSB_ERROR_NO_DEVICE;
  for (const std::uint8_t interface : config.interfaces) {
    if (libusb_kernel_driver_active(session.handle, interface) == 1)
      libusb_set_auto_detach_kernel_driver(session.handle, 1);
    if (const int error = libusb_claim_interface(session.handle, interface); error < 0) return error;
    session.claimed.push_back(interface);
  }
  for (const UsbRequest& request : config.requests) {
    const int error = libusb_control_transfer(session.handle, request.type(false), request.request,
                                              request.value, request.index, nullptr, 0, kTimeoutMs);
    if (error < 0) return error;
  }
  return 0;
}

}  // namespace

Result<CallLoop> open_bare_usb(const BareUsbConfig& config) {
  const std::string name = describe(config.device);
  const auto session = std::make_shared<Session>();
  if (const int error = open(*session, config); error < 0) return libusb_failure(name, "open", error);
  std::vector<unsigned char> memory(config.bytes);
  const auto run = [session, config, memory, name](std::uint64_t calls) mutable -> Result<std::uint64_t> {
    std::uint64_t payload = 0;
    for (std::uint64_t i = 0; i < calls; ++i) {
      int moved = 0;
      const int error = libusb_bulk_transfer(session->handle, config.endpoint, memory.data(),
                                             static_cast<int>(memory.size()), &moved, kTimeoutMs);
      if (error < 0) return libusb_failure(name, "transfer", error);
      const auto bytes = static_cast<std::size_t>(moved);
      const std::size_t packets = (bytes + config.packet_bytes - 1) / config.packet_bytes;
      payload += bytes - std::min(bytes, packets * config.status_bytes);
    }
    return payload;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
