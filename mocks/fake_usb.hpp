#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/usb.hpp"
#include "mocks/sim_usb_device.hpp"

namespace forager::mocks {

// What a socket of a FakeUsb knows of the device in it; outlives the plug for those who still hold it open.
struct FakeUsbSocket {
  SimUsbDevice* device = nullptr;
  hal::UsbDeviceFacts facts;         // drivers as they are now
  std::vector<std::string> drivers;  // of each interface, as they were when the plug came in
  std::vector<bool> claimed;         // each interface: by somebody
  bool plugged = true;
  bool permitted = true;
  std::optional<hal::Error> next_error;
  std::vector<std::pair<const void*, std::function<void()>>> before_unplug;  // what is under way arrives
};

// A USB with emulated devices plugged in. Its time passes with calls alone: one frame, of a millisecond, with
// each call of a pipe, and as many as the time-out has where a blocking call waits, which takes no time
// outside. The plug is pulled 20 frames after unplug() was called: by then what the device holds has arrived.
class FakeUsb final : public hal::Usb {
 public:
  // The device must stay until it was unplugged or this object has ended. What is not plugged in is left
  // alone by the other calls.
  void plug(SimUsbDevice& device, bool permitted = true);
  void unplug(SimUsbDevice& device);
  // udev has come to the device.
  void permit(SimUsbDevice& device);
  // The next transfer with the device fails.
  void fail_next(SimUsbDevice& device, hal::Error error);

 private:
  hal::Result<std::vector<hal::UsbDeviceFacts>> do_devices() override;
  hal::Result<std::unique_ptr<hal::UsbDevice>> do_open(const hal::UsbDeviceFacts& device) override;
  hal::Result<std::vector<hal::UsbEvent>> do_update(hal::Instant now) override;
  [[nodiscard]] std::string_view do_name() const override { return "usb fake"; }
  FakeUsbSocket* socket_of(const SimUsbDevice& device);

  std::vector<std::shared_ptr<FakeUsbSocket>> sockets_;
  std::vector<hal::UsbEvent> events_;
};

}  // namespace forager::mocks
