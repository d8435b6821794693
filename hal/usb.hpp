#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/time.hpp"
#include "hal/usb_device.hpp"
#include "hal/usb_facts.hpp"

namespace forager::hal {

struct UsbEvent {
  bool arrived = false;   // false: left
  bool permitted = true;  // arrived: it may be opened by this user
  UsbDeviceFacts device;
};

// The USB of a machine. Devices that were open when the bus object ends must have ended before it.
class Usb {
 public:
  virtual ~Usb() = default;

  // Devices that fit, in the order of their paths. Needs no permission. Errors: unsupported (built without
  // libusb), io.
  [[nodiscard]] Result<std::vector<UsbDeviceFacts>> devices(const UsbMatch& match = {});

  // Opens the one device that fits. Errors: not_present (none does), invalid_argument (several do: the
  // message names them), permission, busy, disconnected, unsupported, io.
  [[nodiscard]] Result<std::unique_ptr<UsbDevice>> open(const UsbMatch& match);

  // What was plugged in and pulled out since the last call, in order. Call it again and again; it never
  // blocks, and moves no bytes of pipes. A new device is told of once it may be opened: the file appears
  // before udev has given it to its group, so for a bounded time a missing permission counts as "not yet".
  // After that it is told of with permitted = false. Errors: unsupported, io.
  [[nodiscard]] Result<std::vector<UsbEvent>> update(Instant now) { return do_update(now); }

  // "usb by libusb 1.0.26".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<std::vector<UsbDeviceFacts>> do_devices() = 0;
  // `device` is one of do_devices().
  virtual Result<std::unique_ptr<UsbDevice>> do_open(const UsbDeviceFacts& device) = 0;
  virtual Result<std::vector<UsbEvent>> do_update(Instant now) = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

// Opens, and tries again for as long as `at_most` while the answer is that the permission is missing: at the
// start of a program, right after a boot or a plug. Blocks through the clock. Errors as Usb::open().
[[nodiscard]] Result<std::unique_ptr<UsbDevice>> open_when_permitted(Usb& usb, const UsbMatch& match,
                                                                     Clock& clock, Duration at_most);

}  // namespace forager::hal
