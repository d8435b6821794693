#include "hal/usb_device.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace forager::hal {
namespace {

constexpr std::size_t kMostControl = 4096;      // what the kernel takes in one control transfer
constexpr std::size_t kMostBulk = 1024 * 1024;  // no device here sends more in one piece

std::string endpoint_text(std::string_view operation, std::uint8_t endpoint) {
  return fmt::format("{} endpoint 0x{:02x}", operation, endpoint);
}

}  // namespace

Result<> UsbDevice::claim(std::uint8_t interface) {
  const bool known =
      std::any_of(facts_.interfaces.begin(), facts_.interfaces.end(),
                  [&](const UsbInterfaceFacts& candidate) { return candidate.number == interface; });
  if (!known)
    return failed(ErrorCode::invalid_argument, fmt::format("claim interface {}", interface),
                  "the device has no such interface");
  if (claimed_.test(interface)) return {};
  FORAGER_TRY(do_claim(interface));
  claimed_.set(interface);
  return {};
}

Result<> UsbDevice::release(std::uint8_t interface) {
  if (!claimed_.test(interface))
    return failed(ErrorCode::invalid_state, fmt::format("release interface {}", interface),
                  "it is not claimed");
  for (const UsbInterfaceFacts& candidate : facts_.interfaces)
    for (const UsbEndpointFacts& endpoint : candidate.endpoints)
      if (candidate.number == interface) stop(endpoint.address);
  claimed_.reset(interface);
  return do_release(interface);
}

Result<const UsbEndpointFacts*> UsbDevice::usable(std::uint8_t endpoint, bool in,
                                                  std::string_view operation) const {
  for (const UsbInterfaceFacts& interface : facts_.interfaces) {
    const auto found =
        std::find_if(interface.endpoints.begin(), interface.endpoints.end(),
                     [&](const UsbEndpointFacts& candidate) { return candidate.address == endpoint; });
    if (found == interface.endpoints.end() || found->in() != in) continue;
    if (!claimed_.test(interface.number))
      return failed(ErrorCode::invalid_state, endpoint_text(operation, endpoint),
                    fmt::format("interface {} is not claimed", interface.number));
    return &*found;
  }
  return failed(ErrorCode::invalid_argument, endpoint_text(operation, endpoint),
                fmt::format("the device has no such endpoint {} the host", in ? "to" : "from"));
}

Result<const UsbEndpointFacts*> UsbDevice::piped(std::uint8_t endpoint, bool in,
                                                 std::string_view operation) const {
  auto found = usable(endpoint, in, operation);
  if (found && !started_.test(slot(endpoint)))
    return failed(ErrorCode::invalid_state, endpoint_text(operation, endpoint), "no pipe was started");
  return found;
}

Result<> UsbDevice::check_control(const UsbRequest& request, std::size_t bytes, Duration at_most) const {
  if (bytes <= kMostControl && at_most > Duration::zero()) return {};
  return failed(ErrorCode::invalid_argument, fmt::format("request 0x{:02x}", request.request),
                fmt::format("{} bytes within {} ms: 0 to {} bytes and a positive time can be asked for",
                            bytes, at_most / std::chrono::milliseconds(1), kMostControl));
}

Result<std::size_t> UsbDevice::control_in(const UsbRequest& request, std::span<std::byte> into,
                                          Duration at_most) {
  if (auto checked = check_control(request, into.size(), at_most); !checked)
    return fail(std::move(checked).error());
  return do_control_in(request, into, at_most);
}

Result<> UsbDevice::control_out(const UsbRequest& request, std::span<const std::byte> bytes,
                                Duration at_most) {
  FORAGER_TRY(check_control(request, bytes.size(), at_most));
  return do_control_out(request, bytes, at_most);
}

Result<std::size_t> UsbDevice::bulk_in(std::uint8_t endpoint, std::span<std::byte> into, Duration at_most) {
  const auto found = usable(endpoint, true, "read");
  if (!found) return fail(found.error());
  if (into.empty() || into.size() > kMostBulk || into.size() % (*found)->max_packet_bytes != 0 ||
      at_most <= Duration::zero() || started_.test(slot(endpoint)))
    return failed(ErrorCode::invalid_argument, endpoint_text("read", endpoint),
                  fmt::format("{} bytes: whole packets of {}, a positive time and no pipe are needed",
                              into.size(), (*found)->max_packet_bytes));
  return do_bulk_in(**found, into, at_most);
}

Result<> UsbDevice::bulk_out(std::uint8_t endpoint, std::span<const std::byte> bytes, Duration at_most) {
  const auto found = usable(endpoint, false, "write");
  if (!found) return fail(found.error());
  if (bytes.size() > kMostBulk || at_most <= Duration::zero() || started_.test(slot(endpoint)))
    return failed(
        ErrorCode::invalid_argument, endpoint_text("write", endpoint),
        fmt::format("{} bytes: at most {}, a positive time and no pipe are needed", bytes.size(), kMostBulk));
  return do_bulk_out(**found, bytes, at_most);
}

Result<> UsbDevice::clear_halt(std::uint8_t endpoint) {
  const auto found = usable(endpoint, (endpoint & 0x80U) != 0, "clear halt of");
  if (!found) return fail(found.error());
  return do_clear_halt(**found);
}

Result<> UsbDevice::start(std::uint8_t endpoint, const UsbPipeConfig& config) {
  constexpr std::size_t kMostTransfers = 64;
  const bool in = (endpoint & 0x80U) != 0;
  const auto found = usable(endpoint, in, "start a pipe on");
  if (!found) return fail(found.error());
  if (started_.test(slot(endpoint)))
    return failed(ErrorCode::invalid_state, endpoint_text("start a pipe on", endpoint), "it has one already");
  if (config.bytes == 0 || config.bytes > kMostBulk || config.transfers == 0 ||
      config.transfers > kMostTransfers || (in && config.bytes % (*found)->max_packet_bytes != 0))
    return failed(ErrorCode::invalid_argument, endpoint_text("start a pipe on", endpoint),
                  fmt::format("{} transfers of {} bytes: 1 to {}, of whole packets of {}", config.transfers,
                              config.bytes, kMostTransfers, (*found)->max_packet_bytes));
  FORAGER_TRY(do_start(**found, config));
  started_.set(slot(endpoint));
  pipe_bytes_[slot(endpoint)] = config.bytes;
  return {};
}

Result<std::optional<std::size_t>> UsbDevice::poll_in(std::uint8_t endpoint, std::span<std::byte> into) {
  const auto found = piped(endpoint, true, "read");
  if (!found) return fail(found.error());
  if (into.size() < pipe_bytes_[slot(endpoint)])
    return failed(ErrorCode::invalid_argument, endpoint_text("read", endpoint),
                  fmt::format("room for {} bytes is needed", pipe_bytes_[slot(endpoint)]));
  return do_poll_in(**found, into);
}

Result<std::size_t> UsbDevice::push_out(std::uint8_t endpoint, std::span<const std::byte> bytes) {
  const auto found = piped(endpoint, false, "write");
  if (!found) return fail(found.error());
  return do_push_out(**found, bytes);
}

Result<> UsbDevice::drain(std::uint8_t endpoint, Duration at_most) {
  const auto found = piped(endpoint, false, "drain");
  if (!found) return fail(found.error());
  return do_drain(**found, at_most);
}

void UsbDevice::stop(std::uint8_t endpoint) {
  const auto found = piped(endpoint, (endpoint & 0x80U) != 0, "stop");
  if (!found) return;
  do_stop(**found);
  started_.reset(slot(endpoint));
}

}  // namespace forager::hal
