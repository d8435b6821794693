#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/serial.hpp"
#include "mocks/sim_uart.hpp"
#include "mocks/sim_usb_device.hpp"

namespace forager::mocks {

struct SimFtdiConfig {
  std::uint16_t product = 0x6001;  // FT232R
  std::uint16_t release = 0x0600;
  std::uint16_t packet_bytes = 64;  // 512 for chips of the H generation on a high-speed port
  std::string path = "1-1";
  std::string serial = "A5FTDI01";
};

// An FTDI serial chip with one line (AN232B-04 and -05; requests as ftdi_sio of Linux makes them). Declared:
// reset and purge, modem control, RTS/CTS, rate, data format, modem status, latency timer. What is not, and
// divisors that the application note forbids, is stalled. Less than a full packet waits for the latency
// timer, which counts USB frames; every packet begins with two status bytes.
class SimFtdi final : public SimUsbDevice {
 public:
  explicit SimFtdi(hal::ByteStream& line, SimFtdiConfig config = {});

  [[nodiscard]] const hal::UsbDeviceFacts& facts() const override { return facts_; }
  std::optional<std::size_t> control_in(const hal::UsbRequest& request, std::span<std::byte> into) override;
  bool control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) override;
  SimUsbAnswer packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) override;
  SimUsbPacket packet_in(std::uint8_t endpoint, std::span<std::byte> into) override;
  void clear_halt(std::uint8_t) override {}
  void start_of_frame() override;
  void power(bool on) override;

  // The physical face.
  [[nodiscard]] const hal::SerialSettings& line() const { return settings_; }
  [[nodiscard]] double baud() const { return baud_; }
  [[nodiscard]] bool dtr() const { return dtr_; }
  [[nodiscard]] bool rts() const { return rts_; }
  [[nodiscard]] std::uint8_t latency_ms() const { return latency_ms_; }
  // The far device's rate; 0: the same. More than 5 % apart, and what arrives are framing errors.
  void set_far_baud(double baud) { far_baud_ = baud; }
  // Line status of the next packet, once.
  void set_line_status(std::uint8_t status) { next_status_ = status; }

 private:
  bool set_rate(const hal::UsbRequest& request);
  bool set_format(std::uint16_t value);
  bool set_modem(std::uint16_t value);
  [[nodiscard]] std::uint8_t line_status();

  hal::UsbDeviceFacts facts_;
  SimUart uart_;
  hal::SerialSettings settings_;
  double baud_ = 9600.0;
  double far_baud_ = 0.0;
  std::uint16_t packet_bytes_;
  std::uint8_t latency_ms_ = 16;
  unsigned frames_ = 0;  // since the last packet
  std::uint8_t next_status_ = 0;
  bool dtr_ = false;
  bool rts_ = false;
};

}  // namespace forager::mocks
