#include "mocks/sim_usb_echo.hpp"

#include <algorithm>

namespace forager::mocks {
namespace {

constexpr std::uint8_t kOut = 0x01;
constexpr std::uint8_t kIn = 0x81;
constexpr std::uint16_t kPacket = 64;
constexpr std::uint8_t kRecall = 0x42;
constexpr std::uint8_t kRemember = 0x43;
constexpr std::uint8_t kHalt = 0x44;
constexpr std::size_t kMostRemembered = 8;

bool to_device(const hal::UsbRequest& request) {
  return request.kind == hal::UsbRequestKind::vendor && request.to == hal::UsbRecipient::device;
}

}  // namespace

SimUsbEcho::SimUsbEcho(std::string path, std::string serial) {
  facts_ = {.vendor = 0x1209,
            .product = 0x0001,
            .release = 0x0100,
            .serial = std::move(serial),
            .manufacturer = "forager",
            .product_name = "Bulk echo",
            .path = std::move(path),
            .interfaces = {{.number = 0,
                            .class_code = 0xFF,
                            .endpoints = {{kOut, hal::UsbTransferType::bulk, kPacket},
                                          {kIn, hal::UsbTransferType::bulk, kPacket}}}}};
  power(true);
}

void SimUsbEcho::power(bool) {
  packets_.clear();
  halted_.reset();
  constexpr std::string_view kFirst = "PONG";
  memory_.assign(kFirst.size(), std::byte{0});
  std::transform(kFirst.begin(), kFirst.end(), memory_.begin(),
                 [](char letter) { return static_cast<std::byte>(letter); });
}

std::optional<std::size_t> SimUsbEcho::control_in(const hal::UsbRequest& request, std::span<std::byte> into) {
  if (!to_device(request) || request.request != kRecall) return std::nullopt;
  const std::size_t count = std::min(into.size(), memory_.size());
  std::copy_n(memory_.begin(), count, into.begin());
  return count;
}

bool SimUsbEcho::control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) {
  if (!to_device(request)) return false;
  if (request.request == kRemember && bytes.size() <= kMostRemembered) {
    memory_.assign(bytes.begin(), bytes.end());
    return true;
  }
  if (request.request != kHalt || !bytes.empty()) return false;
  halted_.set(kOut);
  halted_.set(kIn);
  return true;
}

SimUsbAnswer SimUsbEcho::packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) {
  if (endpoint != kOut || packet.size() > kPacket || halted_.test(endpoint)) return SimUsbAnswer::stall;
  if (packets_.size() >= kMostPackets) return SimUsbAnswer::nak;
  packets_.emplace_back(packet.begin(), packet.end());
  return SimUsbAnswer::ack;
}

SimUsbPacket SimUsbEcho::packet_in(std::uint8_t endpoint, std::span<std::byte> into) {
  if (endpoint != kIn || halted_.test(endpoint)) return {SimUsbAnswer::stall};
  if (packets_.empty()) return {};
  const std::vector<std::byte> packet = std::move(packets_.front());
  packets_.pop_front();
  const std::size_t count = std::min(into.size(), packet.size());
  std::copy_n(packet.begin(), count, into.begin());
  return {SimUsbAnswer::ack, count};
}

}  // namespace forager::mocks
