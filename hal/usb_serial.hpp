#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/serial.hpp"
#include "hal/time.hpp"
#include "hal/usb.hpp"

namespace forager::hal {

struct UsbSerialConfig {
  UsbMatch device{};
  std::uint8_t port = 0;  // of an adapter with several lines
  SerialSettings line{};
  Duration request_timeout = std::chrono::milliseconds(200);  // of one request while opening
  Duration linger = std::chrono::milliseconds(100);           // at close(), for bytes that have not left yet
  UsbPipeConfig pipe{};                                       // both ways; whole packets
};

// A serial line behind a USB adapter that this process drives itself, without a driver of the kernel and
// without a /dev/tty: for adapters no driver knows, and for exact rates. Taken away from the kernel's driver
// while open, given back at close(). Opens in small steps: open() finds the device, and each poll() makes at
// most one request, which takes about a millisecond and never longer than request_timeout.
//
// Errors of open(), beside those of ByteStream: invalid_argument (several devices fit; settings the adapter
// cannot have, with the nearest rate it can), unsupported (not such an adapter, or a generation it was not
// written for). Errors of poll(): those of UsbDevice.
class UsbSerial : public SerialPort {
 public:
  ~UsbSerial() override = default;  // an adapter closes in its own destructor
  UsbSerial(const UsbSerial&) = delete;
  UsbSerial& operator=(const UsbSerial&) = delete;

  [[nodiscard]] SerialSettings line() const override { return line_; }

 protected:
  UsbSerial(Usb& usb, UsbSerialConfig config, std::string_view kind);

  struct Endpoints {
    std::uint8_t in = 0;
    std::uint8_t out = 0;
  };

  [[nodiscard]] const UsbSerialConfig& config() const { return config_; }
  [[nodiscard]] UsbDevice& device() { return *device_; }
  void set_rate(std::uint32_t baud) { line_.baud = baud; }
  [[nodiscard]] Failure failed(ErrorCode code, std::string operation, std::string detail,
                               std::string mend = {}) const {
    return fail(code, name_, std::move(operation), std::move(detail), std::move(mend));
  }
  // The bulk endpoints of an interface. Errors: unsupported (it has none).
  [[nodiscard]] Result<Endpoints> bulk_endpoints(std::uint8_t interface) const;

 private:
  // What an adapter adds. inspect() finds interfaces and endpoints and checks the settings; nothing is sent.
  // Then step(0), step(1), ... claim and request until one says that there is no more to do.
  virtual Result<Endpoints> inspect() = 0;
  virtual Result<bool> step(std::size_t index) = 0;
  // The payload of a transfer, in place at its front; its size.
  virtual std::size_t payload(std::span<std::byte> transfer) { return transfer.size(); }
  virtual void hang_up() {}  // tells the adapter; errors do not matter any more

  Result<> do_open() override;
  Result<StreamState> do_poll() override;
  Result<std::size_t> do_read(std::span<std::byte> into) override;
  Result<std::size_t> do_write(std::span<const std::byte> bytes) override;
  void do_close() override { finish(); }
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  void finish();
  void drop();  // without another word to the device
  Failure lost(Error error);

  Usb* usb_;
  UsbSerialConfig config_;
  SerialSettings line_;
  std::string name_;
  std::unique_ptr<UsbDevice> device_;
  StreamState state_ = StreamState::closed;
  Endpoints endpoints_;
  std::size_t step_ = 0;
  std::vector<std::byte> buffer_;  // one transfer
  std::size_t taken_ = 0;          // of the payload in it
  std::size_t filled_ = 0;
};

}  // namespace forager::hal
