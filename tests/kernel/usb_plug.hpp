#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "mocks/sim_usb_device.hpp"

namespace forager::kernel {

// Plugs an emulated device into a USB port of the kernel (vhci_hcd, USB/IP over a pair of sockets): drivers
// of the kernel and libusb take it for a real one. A thread carries transfers to it packet by packet; the
// test uses the device only under lock(). The end of the object pulls the plug, whatever is under way.
class UsbPlug {
 public:
  explicit UsbPlug(mocks::SimUsbDevice& device, unsigned port = 0);
  ~UsbPlug();
  UsbPlug(const UsbPlug&) = delete;
  UsbPlug& operator=(const UsbPlug&) = delete;

  [[nodiscard]] std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }

 private:
  struct Transfer {
    std::uint32_t sequence = 0;
    std::uint8_t endpoint = 0;
    std::vector<std::byte> bytes;
    std::size_t done = 0;
  };
  void serve();
  bool take_request();
  void unlink(std::uint32_t sequence, std::uint32_t victim);
  void control(std::uint32_t sequence, std::span<const std::byte> setup, std::vector<std::byte> bytes);
  // Moves packets until every endpoint waits; ended transfers are answered.
  void move_packets();
  bool move(Transfer& transfer);
  void answer(std::uint32_t sequence, std::int32_t status, std::size_t count,
              std::span<const std::byte> received);

  mocks::SimUsbDevice& device_;
  unsigned port_;
  int socket_ = -1;
  std::mutex mutex_;
  std::deque<Transfer> waiting_;
  std::thread thread_;
};

}  // namespace forager::kernel
