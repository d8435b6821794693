#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "hal/usb_serial.hpp"

namespace forager::hal {

// What the line status of packets told.
struct FtdiLineErrors {
  std::uint64_t overruns = 0;  // the chip had no room: bytes were lost
  std::uint64_t parity = 0;    // packets left out
  std::uint64_t framing = 0;
  std::uint64_t breaks = 0;
};

// Takes the two status bytes out of every packet of a transfer (AN232B-04), in place; the payload's size. A
// packet whose status tells of parity, framing or break is left out whole: the chip does not say which of its
// bytes it means. A packet of less than two bytes is no packet and left out.
[[nodiscard]] std::size_t ftdi_payload(std::span<std::byte> transfer, std::size_t packet_bytes,
                                       FtdiLineErrors& errors);

struct FtdiConfig {
  UsbSerialConfig usb{};
  // How long the chip keeps less than a full packet. 16 ms is its default; short answers want less, at the
  // price of more packets.
  Duration latency = std::chrono::milliseconds(2);
};

class Ftdi : public UsbSerial {
 public:
  using UsbSerial::UsbSerial;
  [[nodiscard]] virtual const FtdiLineErrors& errors() const = 0;  // since the port was opened
};

// The serial line of an FTDI chip: 232B and R, 2232C, D and H, 4232H, 232H, X. `port` counts lines from 0.
// line() has the rate that the divider comes to; more than 3 % off is an invalid_argument with the nearest
// one. Errors as UsbSerial; invalid_argument: latency outside 1 to 255 ms, 5 or 6 data bits; unsupported:
// not one of these chips. The bus must outlive the port.
[[nodiscard]] std::unique_ptr<Ftdi> make_ftdi(Usb& usb, const FtdiConfig& config);

}  // namespace forager::hal
