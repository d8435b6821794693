#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hal/error.hpp"
#include "hal/time.hpp"
#include "hal/usb_facts.hpp"

namespace forager::hal {

// A request on the control pipe (USB 2.0, table 9-2); direction and length follow from the call.
enum class UsbRequestKind : std::uint8_t { standard = 0, class_specific = 1, vendor = 2 };
enum class UsbRecipient : std::uint8_t { device = 0, interface = 1, endpoint = 2 };
struct UsbRequest {
  UsbRequestKind kind = UsbRequestKind::vendor;
  UsbRecipient to = UsbRecipient::device;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;

  // bmRequestType.
  [[nodiscard]] std::uint8_t type(bool in) const {
    return static_cast<std::uint8_t>((in ? 0x80U : 0U) | static_cast<unsigned>(kind) << 5U |
                                     static_cast<unsigned>(to));
  }
};

// How much of an endpoint is kept under way by start().
struct UsbPipeConfig {
  std::size_t bytes = 4096;   // of one transfer; to the host a whole number of packets
  std::size_t transfers = 4;  // at once
};

// An open USB device. Claim an interface before its endpoints are used; what is claimed is released, and the
// kernel's driver put back, when the object ends.
//
// Two ways to move bytes: control and bulk calls wait, at most as long as the caller says; a pipe (start,
// poll_in, push_out) never waits and keeps several transfers under way, so that nothing is lost between two
// updates. An endpoint is used in one way at a time.
//
// Errors of every transfer: invalid_argument (no such endpoint or direction, sizes; nothing was sent),
// invalid_state (interface not claimed, pipe not started), disconnected (the plug is out, also in the middle
// of a transfer: how many bytes the device had by then is unknown), timeout (the device does not answer in
// time), refused (it stalled: a request it does not know, or an endpoint that is halted), protocol (more
// bytes than asked for), io.
class UsbDevice {
 public:
  explicit UsbDevice(UsbDeviceFacts facts) : facts_(std::move(facts)), name_(describe(facts_)) {}
  virtual ~UsbDevice() = default;
  UsbDevice(const UsbDevice&) = delete;
  UsbDevice& operator=(const UsbDevice&) = delete;

  // Takes the interface away from the kernel's driver. Errors: invalid_argument (no such interface), busy
  // (another program has it), permission, disconnected, io. Twice is once.
  [[nodiscard]] Result<> claim(std::uint8_t interface);
  // Gives it back to the driver that had it. Errors: invalid_state (not claimed), disconnected, io.
  [[nodiscard]] Result<> release(std::uint8_t interface);

  // Bytes received.
  [[nodiscard]] Result<std::size_t> control_in(const UsbRequest& request, std::span<std::byte> into,
                                               Duration at_most);
  [[nodiscard]] Result<> control_out(const UsbRequest& request, std::span<const std::byte> bytes,
                                     Duration at_most);
  // One transfer of a bulk or interrupt endpoint: ends with a short packet or with a full span, whose size
  // must be a whole number of packets. Bytes received; 0 is an empty packet.
  [[nodiscard]] Result<std::size_t> bulk_in(std::uint8_t endpoint, std::span<std::byte> into,
                                            Duration at_most);
  // All bytes, or an error.
  [[nodiscard]] Result<> bulk_out(std::uint8_t endpoint, std::span<const std::byte> bytes, Duration at_most);
  // Ends a stall of an endpoint.
  [[nodiscard]] Result<> clear_halt(std::uint8_t endpoint);

  // Makes a pipe of the endpoint, in its direction. Allocates here and never again.
  [[nodiscard]] Result<> start(std::uint8_t endpoint, const UsbPipeConfig& config);
  // The oldest transfer that has ended, whole: `into` has room for UsbPipeConfig::bytes. Nothing: none has
  // ended. What arrived before the plug was pulled is handed out before the error.
  [[nodiscard]] Result<std::optional<std::size_t>> poll_in(std::uint8_t endpoint, std::span<std::byte> into);
  // Sends as many bytes as fit into the free transfers, possibly 0. An error is that of an earlier transfer.
  [[nodiscard]] Result<std::size_t> push_out(std::uint8_t endpoint, std::span<const std::byte> bytes);
  // Waits until everything pushed has left. Errors: timeout, and those of transfers.
  [[nodiscard]] Result<> drain(std::uint8_t endpoint, Duration at_most);
  // Ends a pipe; transfers under way are lost. No pipe, no harm.
  void stop(std::uint8_t endpoint);

  [[nodiscard]] const UsbDeviceFacts& facts() const { return facts_; }
  // "usb 0403:6001 at 1-2.4".
  [[nodiscard]] std::string_view name() const { return name_; }

 protected:
  // Endpoint and interface exist, where there is one; directions, sizes and deadlines are right.
  virtual Result<> do_claim(std::uint8_t interface) = 0;
  virtual Result<> do_release(std::uint8_t interface) = 0;
  virtual Result<std::size_t> do_control_in(const UsbRequest& request, std::span<std::byte> into,
                                            Duration at_most) = 0;
  virtual Result<> do_control_out(const UsbRequest& request, std::span<const std::byte> bytes,
                                  Duration at_most) = 0;
  virtual Result<std::size_t> do_bulk_in(const UsbEndpointFacts& endpoint, std::span<std::byte> into,
                                         Duration at_most) = 0;
  virtual Result<> do_bulk_out(const UsbEndpointFacts& endpoint, std::span<const std::byte> bytes,
                               Duration at_most) = 0;
  virtual Result<> do_clear_halt(const UsbEndpointFacts& endpoint) = 0;
  virtual Result<> do_start(const UsbEndpointFacts& endpoint, const UsbPipeConfig& config) = 0;
  virtual Result<std::optional<std::size_t>> do_poll_in(const UsbEndpointFacts& endpoint,
                                                        std::span<std::byte> into) = 0;
  virtual Result<std::size_t> do_push_out(const UsbEndpointFacts& endpoint,
                                          std::span<const std::byte> bytes) = 0;
  virtual Result<> do_drain(const UsbEndpointFacts& endpoint, Duration at_most) = 0;
  virtual void do_stop(const UsbEndpointFacts& endpoint) = 0;

  [[nodiscard]] Failure failed(ErrorCode code, std::string operation, std::string detail,
                               std::string mend = {}) const {
    return fail(code, name_, std::move(operation), std::move(detail), std::move(mend));
  }
  [[nodiscard]] bool claimed(std::uint8_t interface) const { return claimed_.test(interface); }

 private:
  static constexpr std::size_t kEndpoints = 32;  // 16 numbers, two directions
  static std::size_t slot(std::uint8_t endpoint) { return (endpoint & 0x0FU) | (endpoint & 0x80U) >> 3U; }
  // The endpoint, when it may be used now.
  Result<const UsbEndpointFacts*> usable(std::uint8_t endpoint, bool in, std::string_view operation) const;
  Result<const UsbEndpointFacts*> piped(std::uint8_t endpoint, bool in, std::string_view operation) const;
  Result<> check_control(const UsbRequest& request, std::size_t bytes, Duration at_most) const;

  UsbDeviceFacts facts_;
  std::string name_;
  std::bitset<256> claimed_;
  std::bitset<kEndpoints> started_;
  std::array<std::size_t, kEndpoints> pipe_bytes_{};
};

}  // namespace forager::hal
