#pragma once

#include "hal/usb_device.hpp"
#include "mocks/recording_fields.hpp"

namespace forager::mocks {

// An open USB device; borrows it. Endpoints, sizes and times (nanoseconds) as numbers.
//   claim 0 = ok            release 0 = ok
//   control_in 192 1 0 0 2 1000000000 = ok 0001    bmRequestType, bRequest, wValue, wIndex, room, time
//   control_out 64 9 0 0 0102 1000000000 = ok
//   bulk_in 129 64 1000000000 = ok 0102            bulk_out 2 0102 1000000000 = ok
//   clear_halt 129 = ok
//   start 129 4096 4 = ok   stop 129 = ok          drain 2 1000000000 = ok
//   push_out 2 0102 = ok 2                         offered; how many were taken
//   <in129 = ok 0102                               a transfer of the pipe that has ended
class RecordingUsbDevice final : public hal::UsbDevice {
 public:
  RecordingUsbDevice(hal::UsbDevice& device, hal::Recorder& recorder)
      : UsbDevice(device.facts()), device_(&device), recorder_(&recorder) {}

  static hal::Fields fields_of(const hal::UsbRequest& request, bool in) {
    return {hal::field(request.type(in)), hal::field(request.request), hal::field(request.value),
            hal::field(request.index)};
  }
  static std::string pipe_name(const hal::UsbEndpointFacts& endpoint) {
    return "<in" + hal::field(endpoint.address);
  }

 private:
  using Endpoint = hal::UsbEndpointFacts;

  static auto bytes_of(std::span<std::byte> into) {
    return [into](std::size_t size) {
      return hal::Fields{hal::field(std::span<const std::byte>(into.first(size)))};
    };
  }
  hal::Result<> do_claim(std::uint8_t interface) override {
    return taken(*recorder_, name(), "claim", {hal::field(interface)}, device_->claim(interface));
  }
  hal::Result<> do_release(std::uint8_t interface) override {
    return taken(*recorder_, name(), "release", {hal::field(interface)}, device_->release(interface));
  }
  hal::Result<std::size_t> do_control_in(const hal::UsbRequest& request, std::span<std::byte> into,
                                         hal::Duration at_most) override {
    hal::Fields asked = fields_of(request, true);
    asked.push_back(hal::field(into.size()));
    asked.push_back(hal::field(at_most));
    return taken(*recorder_, name(), "control_in", std::move(asked),
                 device_->control_in(request, into, at_most), bytes_of(into));
  }
  hal::Result<> do_control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes,
                               hal::Duration at_most) override {
    hal::Fields asked = fields_of(request, false);
    asked.push_back(hal::field(bytes));
    asked.push_back(hal::field(at_most));
    return taken(*recorder_, name(), "control_out", std::move(asked),
                 device_->control_out(request, bytes, at_most));
  }
  hal::Result<std::size_t> do_bulk_in(const Endpoint& endpoint, std::span<std::byte> into,
                                      hal::Duration at_most) override {
    return taken(*recorder_, name(), "bulk_in",
                 {hal::field(endpoint.address), hal::field(into.size()), hal::field(at_most)},
                 device_->bulk_in(endpoint.address, into, at_most), bytes_of(into));
  }
  hal::Result<> do_bulk_out(const Endpoint& endpoint, std::span<const std::byte> bytes,
                            hal::Duration at_most) override {
    return taken(*recorder_, name(), "bulk_out",
                 {hal::field(endpoint.address), hal::field(bytes), hal::field(at_most)},
                 device_->bulk_out(endpoint.address, bytes, at_most));
  }
  hal::Result<> do_clear_halt(const Endpoint& endpoint) override {
    return taken(*recorder_, name(), "clear_halt", {hal::field(endpoint.address)},
                 device_->clear_halt(endpoint.address));
  }
  hal::Result<> do_start(const Endpoint& endpoint, const hal::UsbPipeConfig& config) override {
    return taken(*recorder_, name(), "start",
                 {hal::field(endpoint.address), hal::field(config.bytes), hal::field(config.transfers)},
                 device_->start(endpoint.address, config));
  }
  hal::Result<std::optional<std::size_t>> do_poll_in(const Endpoint& endpoint,
                                                     std::span<std::byte> into) override {
    auto size = device_->poll_in(endpoint.address, into);
    if (size && !*size) return size;
    return taken(*recorder_, name(), pipe_name(endpoint), {}, std::move(size),
                 [&](const auto& got) { return bytes_of(into)(*got); });
  }
  hal::Result<std::size_t> do_push_out(const Endpoint& endpoint, std::span<const std::byte> bytes) override {
    return taken(*recorder_, name(), "push_out", {hal::field(endpoint.address), hal::field(bytes)},
                 device_->push_out(endpoint.address, bytes),
                 [](std::size_t size) { return hal::Fields{hal::field(size)}; });
  }
  hal::Result<> do_drain(const Endpoint& endpoint, hal::Duration at_most) override {
    return taken(*recorder_, name(), "drain", {hal::field(endpoint.address), hal::field(at_most)},
                 device_->drain(endpoint.address, at_most));
  }
  void do_stop(const Endpoint& endpoint) override {
    device_->stop(endpoint.address);
    recorder_->take(name(), "stop", {hal::field(endpoint.address)}, hal::Fields{});
  }

  hal::UsbDevice* device_;
  hal::Recorder* recorder_;
};

}  // namespace forager::mocks
