#pragma once

#include <string>

#include "mocks/recording_usb.hpp"
#include "mocks/replay.hpp"

namespace forager::mocks {

// A USB device as mocks/recording_usb.hpp noted it; the facts are those of the recorded one. Transfers that
// waited answer at once.
class ReplayUsbDevice final : public hal::UsbDevice {
 public:
  ReplayUsbDevice(hal::UsbDeviceFacts facts, Replay& replay)
      : UsbDevice(std::move(facts)), replay_(&replay) {}

 private:
  using Endpoint = hal::UsbEndpointFacts;

  hal::Result<> done(std::string_view operation, const hal::Fields& asked) {
    return nothing_of(replay_->call(name(), operation, asked));
  }
  hal::Result<std::size_t> bytes_of(std::string_view operation, const hal::Result<hal::Fields>& answer,
                                    std::span<std::byte> into) const {
    if (!answer) return hal::fail(answer.error());
    const auto size = answer->size() == 1 ? copied(answer->front(), into) : std::nullopt;
    if (!size) return Replay::broken(name(), operation);
    return *size;
  }
  hal::Result<> do_claim(std::uint8_t interface) override { return done("claim", {hal::field(interface)}); }
  hal::Result<> do_release(std::uint8_t interface) override {
    return done("release", {hal::field(interface)});
  }
  hal::Result<std::size_t> do_control_in(const hal::UsbRequest& request, std::span<std::byte> into,
                                         hal::Duration at_most) override {
    hal::Fields asked = RecordingUsbDevice::fields_of(request, true);
    asked.push_back(hal::field(into.size()));
    asked.push_back(hal::field(at_most));
    return bytes_of("control_in", replay_->call(name(), "control_in", asked), into);
  }
  hal::Result<> do_control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes,
                               hal::Duration at_most) override {
    hal::Fields asked = RecordingUsbDevice::fields_of(request, false);
    asked.push_back(hal::field(bytes));
    asked.push_back(hal::field(at_most));
    return done("control_out", asked);
  }
  hal::Result<std::size_t> do_bulk_in(const Endpoint& endpoint, std::span<std::byte> into,
                                      hal::Duration at_most) override {
    return bytes_of(
        "bulk_in",
        replay_->call(name(), "bulk_in",
                      {hal::field(endpoint.address), hal::field(into.size()), hal::field(at_most)}),
        into);
  }
  hal::Result<> do_bulk_out(const Endpoint& endpoint, std::span<const std::byte> bytes,
                            hal::Duration at_most) override {
    return done("bulk_out", {hal::field(endpoint.address), hal::field(bytes), hal::field(at_most)});
  }
  hal::Result<> do_clear_halt(const Endpoint& endpoint) override {
    return done("clear_halt", {hal::field(endpoint.address)});
  }
  hal::Result<> do_start(const Endpoint& endpoint, const hal::UsbPipeConfig& config) override {
    return done("start",
                {hal::field(endpoint.address), hal::field(config.bytes), hal::field(config.transfers)});
  }
  hal::Result<std::optional<std::size_t>> do_poll_in(const Endpoint& endpoint,
                                                     std::span<std::byte> into) override {
    const std::string pipe = RecordingUsbDevice::pipe_name(endpoint);
    const auto ended = replay_->arrived(name(), pipe);
    if (!ended) return std::optional<std::size_t>{};
    const auto size = bytes_of(pipe, *ended, into);
    if (!size) return hal::fail(size.error());
    return std::optional(*size);
  }
  hal::Result<std::size_t> do_push_out(const Endpoint& endpoint, std::span<const std::byte> bytes) override {
    const auto answer = replay_->call(name(), "push_out", {hal::field(endpoint.address), hal::field(bytes)});
    if (!answer) return hal::fail(answer.error());
    const auto count = answer->size() == 1 ? hal::integer_in(answer->front()) : std::nullopt;
    if (!count || *count < 0 || static_cast<std::size_t>(*count) > bytes.size())
      return Replay::broken(name(), "push_out");
    return static_cast<std::size_t>(*count);
  }
  hal::Result<> do_drain(const Endpoint& endpoint, hal::Duration at_most) override {
    return done("drain", {hal::field(endpoint.address), hal::field(at_most)});
  }
  void do_stop(const Endpoint& endpoint) override {
    static_cast<void>(replay_->call(name(), "stop", {hal::field(endpoint.address)}));
  }

  Replay* replay_;
};

}  // namespace forager::mocks
