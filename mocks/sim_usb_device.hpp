#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/usb_device.hpp"

namespace forager::mocks {

enum class SimUsbAnswer : std::uint8_t {
  ack,
  nak,    // not now: the host asks again
  stall,  // the endpoint is halted, or the request unknown
};
struct SimUsbPacket {
  SimUsbAnswer answer = SimUsbAnswer::nak;
  std::size_t bytes = 0;  // with ack
};

// An emulated device at the end of a USB cable, seen packet by packet (USB 2.0, chapter 8). What it does not
// declare it stalls. Standard requests that the host's own software answers from the descriptors do not come
// here.
class SimUsbDevice {
 public:
  virtual ~SimUsbDevice() = default;
  [[nodiscard]] virtual const hal::UsbDeviceFacts& facts() const = 0;
  // Bytes put into `into`; nothing: stalled.
  virtual std::optional<std::size_t> control_in(const hal::UsbRequest& request,
                                                std::span<std::byte> into) = 0;
  // False: stalled.
  virtual bool control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) = 0;
  // One packet, at most as long as the endpoint's largest.
  virtual SimUsbAnswer packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) = 0;
  virtual SimUsbPacket packet_in(std::uint8_t endpoint, std::span<std::byte> into) = 0;
  virtual void clear_halt(std::uint8_t endpoint) = 0;
  // A millisecond has passed on the bus: the clock of devices that have none of their own.
  virtual void start_of_frame() {}
  // The plug is in, or out: what a power cycle does to it.
  virtual void power(bool on) = 0;
};

}  // namespace forager::mocks
