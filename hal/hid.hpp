#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/hid_device.hpp"

namespace forager::hal {

enum class HidSharing : std::uint8_t {
  shared,     // the kernel goes on using it: a keyboard types into the console, too
  exclusive,  // what it sends comes here and nowhere else
};

// The HID devices of a machine.
class Hid {
 public:
  virtual ~Hid() = default;

  // Devices that fit, in the order of their paths. Needs no permission. Errors: unsupported (built without
  // hidapi), io.
  [[nodiscard]] Result<std::vector<HidDeviceFacts>> devices(const HidMatch& match = {});

  // Opens the one device that fits. Errors: not_present, invalid_argument (several fit: the message names
  // them), busy (a driver of the kernel has it and leaves no way in: the message says which; or somebody else
  // has it exclusively), permission, unsupported, io.
  [[nodiscard]] Result<std::unique_ptr<HidDevice>> open(const HidMatch& match,
                                                        HidSharing sharing = HidSharing::shared);

  // "hid by hidapi 0.13.1".
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<std::vector<HidDeviceFacts>> do_devices() = 0;
  // `device` is one of do_devices() and has a path.
  virtual Result<std::unique_ptr<HidDevice>> do_open(const HidDeviceFacts& device, HidSharing sharing) = 0;
  [[nodiscard]] virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
