#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/hid_device.hpp"

namespace forager::mocks {

// An emulated HID device, seen report by report. What it does not declare it refuses.
class SimHidDevice {
 public:
  virtual ~SimHidDevice() = default;
  [[nodiscard]] virtual const hal::HidDeviceFacts& facts() const = 0;
  // The report descriptor (HID 1.11, section 6.2.2), for whoever shows the device to a kernel.
  [[nodiscard]] virtual std::span<const std::uint8_t> report_descriptor() const = 0;
  // The first byte is the report's number, 0 if there is one kind only. False: stalled.
  virtual bool output(std::span<const std::byte> report) = 0;
  // The next input report, without a number if there is one kind only; 0: none.
  virtual std::size_t input(std::span<std::byte> into) = 0;
  // Feature reports, the number first; nothing or false: stalled.
  virtual std::optional<std::size_t> get_feature(std::span<std::byte> into) = 0;
  virtual bool set_feature(std::span<const std::byte> report) = 0;
  virtual void power(bool on) = 0;
};

}  // namespace forager::mocks
