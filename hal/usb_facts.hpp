#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace forager::hal {

// What a device says of itself in its descriptors (USB 2.0, section 9.6), and where it is plugged in.

enum class UsbTransferType : std::uint8_t { control, isochronous, bulk, interrupt };  // as in bmAttributes

struct UsbEndpointFacts {
  std::uint8_t address = 0;  // bEndpointAddress: bit 7 set: to the host
  UsbTransferType type = UsbTransferType::bulk;
  std::uint16_t max_packet_bytes = 64;

  [[nodiscard]] bool in() const { return (address & 0x80U) != 0; }
};

struct UsbInterfaceFacts {
  std::uint8_t number = 0;
  std::uint8_t class_code = 0;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
  std::vector<UsbEndpointFacts> endpoints{};  // of alternate setting 0
  std::string driver{};                       // the kernel's driver that has it now: "ftdi_sio"; empty: none
};

struct UsbDeviceFacts {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::uint16_t release = 0;  // bcdDevice: 0x0600 is version 6.00
  std::string serial{};       // empty: it has none
  std::string manufacturer{};
  std::string product_name{};
  std::string path{};  // bus and ports, the same as long as nobody moves the plug: "1-2.4"
  std::vector<UsbInterfaceFacts> interfaces{};
};

// Which device is meant; what is empty fits every device.
struct UsbMatch {
  std::optional<std::uint16_t> vendor{};
  std::optional<std::uint16_t> product{};
  std::string serial{};
  std::string path{};
};

[[nodiscard]] bool fits(const UsbMatch& match, const UsbDeviceFacts& device);

// "usb 0403:6001 at 1-2.4".
[[nodiscard]] std::string describe(const UsbDeviceFacts& device);
// "usb 0403:6001 serial A50285BI"; "usb any device".
[[nodiscard]] std::string describe(const UsbMatch& match);

}  // namespace forager::hal
