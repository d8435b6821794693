#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/hid.hpp"
#include "mocks/sim_hid_device.hpp"

namespace forager::mocks {

// What a FakeHid knows of a device plugged in; outlives the plug for those who still hold it open.
struct FakeHidSocket {
  SimHidDevice* device = nullptr;
  hal::HidDeviceFacts facts;
  bool plugged = true;
  bool permitted = true;
  bool exclusive = false;            // somebody has it so
  std::uint32_t shared_reports = 0;  // input reports that reached the kernel as well
  std::optional<hal::Error> next_error;
};

// A machine with emulated HID devices plugged in. Time does not pass while a call waits: where nothing is
// there, the time-out comes at once.
class FakeHid final : public hal::Hid {
 public:
  // The device must stay until it was unplugged or this object has ended. What is not plugged in is left
  // alone by the other calls.
  void plug(SimHidDevice& device);
  void unplug(SimHidDevice& device);
  void permit(SimHidDevice& device, bool permitted);
  // A driver of the kernel has it and leaves no hidraw, as hid-mcp2221 of Linux 6.1 does.
  void hold(SimHidDevice& device, std::string driver);
  // The next call of an open device fails.
  void fail_next(SimHidDevice& device, hal::Error error);
  // Input reports that somebody else, such as a console, got to see while the device was open here.
  [[nodiscard]] std::uint32_t leaked(const SimHidDevice& device) const;

 private:
  hal::Result<std::vector<hal::HidDeviceFacts>> do_devices() override;
  hal::Result<std::unique_ptr<hal::HidDevice>> do_open(const hal::HidDeviceFacts& device,
                                                       hal::HidSharing sharing) override;
  [[nodiscard]] std::string_view do_name() const override { return "hid fake"; }
  [[nodiscard]] std::shared_ptr<FakeHidSocket> socket_of(const SimHidDevice& device) const;

  std::vector<std::shared_ptr<FakeHidSocket>> sockets_;
};

}  // namespace forager::mocks
