#pragma once

#include <string>

namespace forager::kernel {

// A CDC-ACM serial adapter made by the kernel itself: a gadget behind an emulated plug (dummy_hcd). What a
// program writes to the host's end, /dev/ttyACM0, the driver cdc-acm carries over USB to the device's end,
// /dev/ttyGS0, and back.
class SerialGadget {
 public:
  SerialGadget();  // plugged in
  ~SerialGadget();
  SerialGadget(const SerialGadget&) = delete;
  SerialGadget& operator=(const SerialGadget&) = delete;

  // Both wait until the host has noticed.
  void unplug();
  void plug_in();
  [[nodiscard]] static std::string host_end() { return "/dev/ttyACM0"; }
  [[nodiscard]] static std::string device_end() { return "/dev/ttyGS0"; }

 private:
  bool plugged_ = false;
};

}  // namespace forager::kernel
