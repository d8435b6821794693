#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "mocks/fake_usb.hpp"

namespace forager::mocks {

// A device of a FakeUsb, open. Pipes move their bytes when somebody calls, as fast as the device takes them.
class FakeUsbDevice final : public hal::UsbDevice {
 public:
  explicit FakeUsbDevice(std::shared_ptr<FakeUsbSocket> socket);
  ~FakeUsbDevice() override;

 private:
  struct Transfer {
    std::vector<std::byte> bytes;
    std::size_t done = 0;
  };
  struct Pipe {
    explicit Pipe(const hal::UsbPipeConfig& how) : config(how) {}
    hal::UsbPipeConfig config;
    std::deque<Transfer> ended;  // to the host
    std::optional<Transfer> filling;
    std::deque<Transfer> leaving;  // from the host
    bool stalled = false;
  };

  hal::Result<> do_claim(std::uint8_t interface) override;
  hal::Result<> do_release(std::uint8_t interface) override;
  hal::Result<std::size_t> do_control_in(const hal::UsbRequest& request, std::span<std::byte> into,
                                         hal::Duration at_most) override;
  hal::Result<> do_control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes,
                               hal::Duration at_most) override;
  hal::Result<std::size_t> do_bulk_in(const hal::UsbEndpointFacts& endpoint, std::span<std::byte> into,
                                      hal::Duration at_most) override;
  hal::Result<> do_bulk_out(const hal::UsbEndpointFacts& endpoint, std::span<const std::byte> bytes,
                            hal::Duration at_most) override;
  hal::Result<> do_clear_halt(const hal::UsbEndpointFacts& endpoint) override;
  hal::Result<> do_start(const hal::UsbEndpointFacts& endpoint, const hal::UsbPipeConfig& config) override;
  hal::Result<std::optional<std::size_t>> do_poll_in(const hal::UsbEndpointFacts& endpoint,
                                                     std::span<std::byte> into) override;
  hal::Result<std::size_t> do_push_out(const hal::UsbEndpointFacts& endpoint,
                                       std::span<const std::byte> bytes) override;
  hal::Result<> do_drain(const hal::UsbEndpointFacts& endpoint, hal::Duration at_most) override;
  void do_stop(const hal::UsbEndpointFacts& endpoint) override;

  hal::Result<> admit(const std::string& operation);
  // How far one transfer gets now, and whether it has ended.
  SimUsbAnswer fill(const hal::UsbEndpointFacts& endpoint, Transfer& transfer, bool& ended);
  SimUsbAnswer send(const hal::UsbEndpointFacts& endpoint, Transfer& transfer);
  void pump_in(const hal::UsbEndpointFacts& endpoint, Pipe& pipe);
  void pump_out(const hal::UsbEndpointFacts& endpoint, Pipe& pipe);
  void everything_arrives();
  template <class Act>
  void each_pipe(const Act& act);
  void frame();
  [[nodiscard]] hal::Failure stalled(const std::string& operation) const;
  [[nodiscard]] std::size_t index_of(std::uint8_t interface) const;
  void unclaim(std::size_t index);

  std::shared_ptr<FakeUsbSocket> socket_;
  std::array<std::optional<Pipe>, 256> pipes_;
};

}  // namespace forager::mocks
