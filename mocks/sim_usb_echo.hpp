#pragma once

#include <bitset>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "mocks/sim_usb_device.hpp"

namespace forager::mocks {

// A device to try a USB host with (1209:0001 of pid.codes, for tests), serial number SN42: interface 0 with
// bulk endpoints 0x01 and 0x81 of 64 bytes a packet. What is written to 0x01 can be read from 0x81, transfers
// kept apart. Vendor requests to the device: 0x42 in answers the eight bytes last sent with 0x43 out
// (first "PONG"); 0x44 out halts both endpoints.
class SimUsbEcho final : public SimUsbDevice {
 public:
  explicit SimUsbEcho(std::string path = "1-1", std::string serial = "SN42");

  [[nodiscard]] const hal::UsbDeviceFacts& facts() const override { return facts_; }
  std::optional<std::size_t> control_in(const hal::UsbRequest& request, std::span<std::byte> into) override;
  bool control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) override;
  SimUsbAnswer packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) override;
  SimUsbPacket packet_in(std::uint8_t endpoint, std::span<std::byte> into) override;
  void clear_halt(std::uint8_t endpoint) override { halted_.reset(endpoint); }
  void power(bool on) override;

  void set_driver(std::string driver) { facts_.interfaces[0].driver = std::move(driver); }
  // At most this many packets wait to be read back; more are not acknowledged.
  static constexpr std::size_t kMostPackets = 256;

 private:
  hal::UsbDeviceFacts facts_;
  std::deque<std::vector<std::byte>> packets_;
  std::vector<std::byte> memory_;
  std::bitset<256> halted_;
};

}  // namespace forager::mocks
