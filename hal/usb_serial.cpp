#include "hal/usb_serial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace forager::hal {

UsbSerial::UsbSerial(Usb& usb, UsbSerialConfig config, std::string_view kind)
    : usb_(&usb),
      config_(std::move(config)),
      line_(config_.line),
      name_(fmt::format("{} {}", kind, describe(config_.device))),
      buffer_(config_.pipe.bytes) {}

Result<UsbSerial::Endpoints> UsbSerial::bulk_endpoints(std::uint8_t interface) const {
  Endpoints found;
  for (const UsbInterfaceFacts& candidate : device_->facts().interfaces) {
    if (candidate.number != interface) continue;
    for (const UsbEndpointFacts& endpoint : candidate.endpoints)
      if (endpoint.type == UsbTransferType::bulk) (endpoint.in() ? found.in : found.out) = endpoint.address;
  }
  if (found.in != 0 && found.out != 0) return found;
  return failed(ErrorCode::unsupported, "open",
                fmt::format("interface {} has no bulk endpoints both ways", interface));
}

void UsbSerial::drop() {
  device_.reset();
  state_ = StreamState::closed;
  line_ = config_.line;
  taken_ = 0;
  filled_ = 0;
}

Failure UsbSerial::lost(Error error) {
  drop();
  return fail(std::move(error));
}

void UsbSerial::finish() {
  if (device_ && state_ == StreamState::open) {
    static_cast<void>(device_->drain(endpoints_.out, config_.linger));
    hang_up();
  }
  drop();
}

Result<> UsbSerial::do_open() {
  if (state_ != StreamState::closed)
    return failed(ErrorCode::invalid_state, "open", "the port is open already");
  FORAGER_TRY(check(config_.line, name_));
  auto device = usb_->open(config_.device);
  if (!device) return fail(std::move(device).error());
  device_ = *std::move(device);
  const auto endpoints = inspect();
  if (!endpoints) return lost(endpoints.error());
  endpoints_ = *endpoints;
  step_ = 0;
  state_ = StreamState::opening;
  return {};
}

Result<StreamState> UsbSerial::do_poll() {
  if (state_ != StreamState::opening) return state_;
  const auto more = step(step_);
  if (!more) return lost(more.error());
  ++step_;
  if (*more) return state_;
  for (const std::uint8_t endpoint : {endpoints_.in, endpoints_.out})
    if (auto started = device_->start(endpoint, config_.pipe); !started)
      return lost(std::move(started).error());
  state_ = StreamState::open;
  return state_;
}

Result<std::size_t> UsbSerial::do_read(std::span<std::byte> into) {
  if (state_ != StreamState::open) return failed(ErrorCode::invalid_state, "read", "the port is not open");
  std::size_t count = 0;
  while (count < into.size()) {
    if (taken_ == filled_) {
      const auto ended = device_->poll_in(endpoints_.in, buffer_);
      // What is in hand goes first; the error comes back at the next call.
      if (!ended && count > 0) break;
      if (!ended) return lost(ended.error());
      if (!*ended) break;
      taken_ = 0;
      filled_ = payload(std::span(buffer_).first(**ended));
      continue;
    }
    const std::size_t piece = std::min(into.size() - count, filled_ - taken_);
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(taken_), piece,
                into.begin() + static_cast<std::ptrdiff_t>(count));
    taken_ += piece;
    count += piece;
  }
  return count;
}

Result<std::size_t> UsbSerial::do_write(std::span<const std::byte> bytes) {
  if (state_ != StreamState::open) return failed(ErrorCode::invalid_state, "write", "the port is not open");
  auto pushed = device_->push_out(endpoints_.out, bytes);
  if (pushed) return pushed;
  // What arrived before the plug was pulled is read first, and with it the loss.
  if (pushed.error().code == ErrorCode::disconnected) {
    if (taken_ < filled_) return bytes.size();
    const auto ended = device_->poll_in(endpoints_.in, buffer_);
    if (ended && *ended) {
      taken_ = 0;
      filled_ = payload(std::span(buffer_).first(**ended));
      return bytes.size();
    }
  }
  return lost(std::move(pushed).error());
}

}  // namespace forager::hal
