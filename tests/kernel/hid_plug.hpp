#pragma once

#include <atomic>
#include <mutex>
#include <span>
#include <thread>

#include "mocks/sim_hid_device.hpp"

namespace forager::kernel {

// Plugs an emulated HID device into the kernel (uhid): hidraw, input devices and the kernel's own drivers see
// it as a USB one. A thread carries reports; the test uses the device only under lock(). The end of the
// object pulls the plug.
class HidPlug {
 public:
  explicit HidPlug(mocks::SimHidDevice& device);
  ~HidPlug();
  HidPlug(const HidPlug&) = delete;
  HidPlug& operator=(const HidPlug&) = delete;

  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

 private:
  void create();
  void serve();
  void take_event();
  void take_output(std::span<const std::byte> report);
  void send_inputs();

  mocks::SimHidDevice& device_;
  int uhid_ = -1;
  bool numbered_ = false;  // output reports of the device
  std::mutex mutex_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace forager::kernel
