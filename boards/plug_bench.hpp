#pragma once

#include <memory>

#include "hal/error.hpp"
#include "hal/hid.hpp"
#include "hal/time.hpp"
#include "hal/usb.hpp"

namespace forager::boards {

// What is plugged into a machine: this one, or one that exists in this process only.
class PlugBench {
 public:
  virtual ~PlugBench() = default;
  // Errors: unsupported (built without the library), io (it does not start).
  [[nodiscard]] virtual hal::Result<hal::Usb*> usb() = 0;
  [[nodiscard]] virtual hal::Result<hal::Hid*> hid() = 0;
  // Lets emulated hands plug and unplug.
  virtual void advance(hal::Instant now) = 0;
};

[[nodiscard]] std::unique_ptr<PlugBench> real_plugs();
// One USB and one HID device that echo what they are sent, plugged in from the start; after one second a
// second USB device comes that this user may not open, and the first HID device reports; after two the second
// goes.
[[nodiscard]] std::unique_ptr<PlugBench> emulated_plugs();

}  // namespace forager::boards
