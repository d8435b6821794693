#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/serial.hpp"
#include "mocks/sim_uart.hpp"
#include "mocks/sim_usb_device.hpp"

namespace forager::mocks {

// A CDC-ACM device (USB CDC 1.2, PSTN subclass 1.2) as microcontrollers have them: 1209:0003, interface 0 for
// control with an interrupt endpoint that never has anything to say, interface 1 for data, 64 bytes a packet.
// Takes SET_LINE_CODING, GET_LINE_CODING and SET_CONTROL_LINE_STATE; everything else is stalled, and so are
// line codings the class does not know.
class SimCdcAcm final : public SimUsbDevice {
 public:
  explicit SimCdcAcm(hal::ByteStream& line, std::string path = "1-1", std::string serial = "CDC1");

  [[nodiscard]] const hal::UsbDeviceFacts& facts() const override { return facts_; }
  std::optional<std::size_t> control_in(const hal::UsbRequest& request, std::span<std::byte> into) override;
  bool control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) override;
  SimUsbAnswer packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) override;
  SimUsbPacket packet_in(std::uint8_t endpoint, std::span<std::byte> into) override;
  void clear_halt(std::uint8_t) override {}
  void start_of_frame() override { uart_.pump(); }
  void power(bool on) override;

  // The physical face.
  [[nodiscard]] const hal::SerialSettings& line() const { return settings_; }
  [[nodiscard]] bool dtr() const { return dtr_; }
  [[nodiscard]] bool rts() const { return rts_; }
  // A device that takes one rate only, whatever it is asked for.
  void fix_rate(std::uint32_t baud) { fixed_baud_ = baud; }

 private:
  bool set_line_coding(std::span<const std::byte> bytes);

  hal::UsbDeviceFacts facts_;
  SimUart uart_;
  hal::SerialSettings settings_;
  std::uint32_t fixed_baud_ = 0;
  bool dtr_ = false;
  bool rts_ = false;
  bool full_packet_ = false;  // the last one was: an empty one must end the transfer
};

}  // namespace forager::mocks
