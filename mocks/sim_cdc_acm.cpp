#include "mocks/sim_cdc_acm.hpp"

#include <algorithm>
#include <utility>

#include "hal/cdc_acm_wire.hpp"

namespace forager::mocks {

using namespace hal::cdc_acm;

namespace {

constexpr std::uint8_t kNotify = 0x82;
constexpr std::uint8_t kIn = 0x81;
constexpr std::uint8_t kOut = 0x01;
constexpr std::uint16_t kPacket = 64;
constexpr std::size_t kMemory = 1024;

bool for_control(const hal::UsbRequest& request) {
  return request.kind == hal::UsbRequestKind::class_specific && request.to == hal::UsbRecipient::interface &&
         request.index == 0;
}

}  // namespace

SimCdcAcm::SimCdcAcm(hal::ByteStream& line, std::string path, std::string serial)
    : uart_(line, kMemory, kMemory) {
  using hal::UsbTransferType;
  facts_ = {.vendor = 0x1209,
            .product = 0x0003,
            .release = 0x0100,
            .serial = std::move(serial),
            .manufacturer = "forager",
            .product_name = "Serial port",
            .path = std::move(path),
            .interfaces = {
                {.number = 0,
                 .class_code = kCommunicationClass,
                 .subclass = kAbstractControl,
                 .protocol = 1,
                 .endpoints = {{kNotify, UsbTransferType::interrupt, 16}},
                 .driver = "cdc_acm"},
                {.number = 1,
                 .class_code = kDataClass,
                 .endpoints = {{kOut, UsbTransferType::bulk, kPacket}, {kIn, UsbTransferType::bulk, kPacket}},
                 .driver = "cdc_acm"}}};
}

void SimCdcAcm::power(bool) {
  uart_.set_dtr(false);
  uart_.clear_received();
  uart_.clear_sending();
  settings_ = {.baud = fixed_baud_ != 0 ? fixed_baud_ : 9600};
  dtr_ = false;
  rts_ = false;
  full_packet_ = false;
}

std::optional<std::size_t> SimCdcAcm::control_in(const hal::UsbRequest& request, std::span<std::byte> into) {
  if (!for_control(request) || request.request != kGetLineCoding || request.value != 0 ||
      into.size() < kLineCodingBytes)
    return std::nullopt;
  for (std::size_t i = 0; i < kStopAt; ++i) into[i] = static_cast<std::byte>(settings_.baud >> 8 * i & 0xFFU);
  const std::uint8_t stop = settings_.stop_bits == 2 ? kTwoStop : kOneStop;
  std::uint8_t parity = kNoParity;
  if (settings_.parity == hal::Parity::odd) parity = kOdd;
  if (settings_.parity == hal::Parity::even) parity = kEven;
  into[kStopAt] = std::byte{stop};
  into[kParityAt] = std::byte{parity};
  into[kDataBitsAt] = std::byte{settings_.data_bits};
  return kLineCodingBytes;
}

bool SimCdcAcm::set_line_coding(std::span<const std::byte> bytes) {
  if (bytes.size() != kLineCodingBytes) return false;
  const auto field = [&](std::size_t at) { return std::to_integer<std::uint8_t>(bytes[at]); };
  hal::SerialSettings wanted{.baud = 0};
  for (std::size_t i = kStopAt; i-- > 0;) wanted.baud = wanted.baud << 8U | field(i);
  switch (field(kStopAt)) {
    case kOneStop:
      wanted.stop_bits = 1;
      break;
    case kTwoStop:
      wanted.stop_bits = 2;
      break;
    default:
      return false;
  }
  switch (field(kParityAt)) {
    case kNoParity:
      break;
    case kOdd:
      wanted.parity = hal::Parity::odd;
      break;
    case kEven:
      wanted.parity = hal::Parity::even;
      break;
    default:
      return false;
  }
  wanted.data_bits = field(kDataBitsAt);
  if (wanted.data_bits < 5 || wanted.data_bits > 8 || wanted.baud == 0) return false;
  if (fixed_baud_ != 0) wanted.baud = fixed_baud_;
  settings_ = wanted;
  return true;
}

bool SimCdcAcm::control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) {
  if (!for_control(request)) return false;
  if (request.request == kSetLineCoding && request.value == 0) return set_line_coding(bytes);
  if (request.request != kSetControlLineState || !bytes.empty() || (request.value & ~(kDtr | kRts)) != 0)
    return false;
  dtr_ = (request.value & kDtr) != 0;
  rts_ = (request.value & kRts) != 0;
  uart_.set_dtr(dtr_);
  return true;
}

SimUsbAnswer SimCdcAcm::packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) {
  if (endpoint != kOut || packet.size() > kPacket) return SimUsbAnswer::stall;
  return uart_.put(packet) ? SimUsbAnswer::ack : SimUsbAnswer::nak;
}

SimUsbPacket SimCdcAcm::packet_in(std::uint8_t endpoint, std::span<std::byte> into) {
  if (endpoint == kNotify) return {};
  if (endpoint != kIn) return {SimUsbAnswer::stall};
  uart_.pump();
  if (uart_.waiting() == 0) {
    if (!std::exchange(full_packet_, false)) return {};
    return {SimUsbAnswer::ack, 0};
  }
  const std::size_t size = uart_.take(into.first(std::min<std::size_t>(into.size(), kPacket)));
  full_packet_ = size == kPacket;
  return {SimUsbAnswer::ack, size};
}

}  // namespace forager::mocks
