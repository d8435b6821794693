#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// The hardware layer against the vendor's call that it makes, for the outermost loop to time in turn. Only
// one of the two is open at a time: a line has one holder.
struct OverheadContest {
  // Makes so many calls in a row; what they did, in `unit`. Errors: those of the call.
  using Side = std::function<hal::Result<std::uint64_t>(std::uint64_t calls)>;

  std::string name;       // "GPIO set"
  std::string ours;       // "DigitalOut::set"
  std::string bare;       // "libgpiod 1.6.3"
  std::string unit;       // what is counted: "call", or "byte"
  hal::Duration batch{};  // so long should the calls in a row last: some dozens of them
  std::function<hal::Result<Side>()> open_ours;
  std::function<hal::Result<Side>()> open_bare;
  bool may_be_silent = false;  // that nothing comes (timeout) is no failure
};

// Toggles a line, given as CHIP/LINE, which ends inactive. Errors: invalid_argument, and those of
// hal::list_gpio() and hal::open_gpio_out().
[[nodiscard]] hal::Result<OverheadContest> overhead_gpio(const std::string& line);

// Reads register 0 of a chip, given as BUS@ADDRESS. Errors: invalid_argument.
[[nodiscard]] hal::Result<OverheadContest> overhead_i2c(const std::string& chip);

// The same code over a kernel that does nothing, against a system call that does nothing: what the layer adds
// on a machine without a bus, and the worst that its share can be.
[[nodiscard]] OverheadContest overhead_i2c_floor();

// Reads four holding registers of a device emulated by a thread of this process, over a pseudo-terminal.
// Errors: unsupported (built without libmodbus), io (no pseudo-terminal).
[[nodiscard]] hal::Result<OverheadContest> overhead_modbus();

// A CDC-ACM or FTDI device: blocking transfers of 4 KiB to it, its serial line in user space that way and, if
// it sends, the other way; all against blocking transfers of libusb. What is sent leaves on the line.
struct OverheadUsbPlace {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint32_t baud = 115200;  // at least 57600: 4 KiB in less than the second a transfer may take
};
// Errors: not_present, invalid_argument (several fit), unsupported (no such adapter, or built without
// libusb), io.
[[nodiscard]] hal::Result<std::vector<OverheadContest>> overhead_usb(const OverheadUsbPlace& place);

}  // namespace forager::boards
