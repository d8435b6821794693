#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/usb_device.hpp"

struct libusb_context;
struct libusb_device_handle;
struct libusb_transfer;

namespace forager::hal {

// An endpoint with several transfers under way at once. All memory is had at construction.
class LibusbPipe {
 public:
  LibusbPipe(libusb_context* context, libusb_device_handle* handle, std::string device,
             const UsbEndpointFacts& endpoint, const UsbPipeConfig& config);
  // Cancels what is under way, and waits for that.
  ~LibusbPipe();
  LibusbPipe(const LibusbPipe&) = delete;
  LibusbPipe& operator=(const LibusbPipe&) = delete;

  // To the host: puts every transfer under way.
  [[nodiscard]] Result<> start();
  [[nodiscard]] Result<std::optional<std::size_t>> poll_in(std::span<std::byte> into);
  [[nodiscard]] Result<std::size_t> push_out(std::span<const std::byte> bytes);
  [[nodiscard]] Result<> drain(Duration at_most);

 private:
  enum class State : std::uint8_t { idle, under_way, ended };
  struct Slot {
    libusb_transfer* transfer = nullptr;
    std::vector<std::byte> buffer;
    State state = State::idle;
  };

  [[nodiscard]] Slot& oldest() { return slots_[oldest_]; }
  // Lets the library work for at most this long.
  void events(Duration at_most);
  [[nodiscard]] Result<> submit(Slot& slot, std::size_t bytes);
  [[nodiscard]] Result<> submit_idle();
  [[nodiscard]] Result<> judge_sent();
  [[nodiscard]] bool wait(Duration at_most);  // until nothing is under way
  // Takes everything back and says why.
  [[nodiscard]] Failure broken(int error);
  [[nodiscard]] std::string operation() const;

  libusb_context* context_;
  libusb_device_handle* handle_;
  std::string device_;
  UsbEndpointFacts endpoint_;
  std::unique_ptr<std::vector<Slot>> owned_;  // let go of where the kernel may still write into it
  std::vector<Slot>& slots_;
  std::size_t oldest_ = 0;
  int failed_ = 0;  // LIBUSB_ERROR_ that came with the last bytes
};

}  // namespace forager::hal
