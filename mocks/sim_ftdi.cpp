#include "mocks/sim_ftdi.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hal/ftdi_wire.hpp"

namespace forager::mocks {

using namespace hal::ftdi;

namespace {

constexpr std::uint8_t kIn = 0x81;
constexpr std::uint8_t kOut = 0x02;
constexpr std::size_t kReceiveMemory = 256;  // FT232R data sheet, section 4.1
constexpr std::size_t kTransmitMemory = 128;
constexpr std::uint8_t kDefaultLatencyMs = 16;

bool vendor(const hal::UsbRequest& request) {
  return request.kind == hal::UsbRequestKind::vendor && request.to == hal::UsbRecipient::device;
}

bool fast(std::uint16_t release) { return release == kFt2232H || release == kFt4232H || release == kFt232H; }

}  // namespace

SimFtdi::SimFtdi(hal::ByteStream& line, SimFtdiConfig config)
    : uart_(line, kReceiveMemory, std::max<std::size_t>(kTransmitMemory, 2 * config.packet_bytes)),
      packet_bytes_(config.packet_bytes) {
  using hal::UsbTransferType;
  facts_ = {.vendor = kVendor,
            .product = config.product,
            .release = config.release,
            .serial = std::move(config.serial),
            .manufacturer = "FTDI",
            .product_name = "FT232R USB UART",
            .path = std::move(config.path),
            .interfaces = {{.number = 0,
                            .class_code = 0xFF,
                            .subclass = 0xFF,
                            .protocol = 0xFF,
                            .endpoints = {{kIn, UsbTransferType::bulk, packet_bytes_},
                                          {kOut, UsbTransferType::bulk, packet_bytes_}},
                            .driver = "ftdi_sio"}}};
}

void SimFtdi::power(bool) {
  uart_.set_dtr(false);
  uart_.clear_received();
  uart_.clear_sending();
  settings_ = {.baud = 9600};
  baud_ = 9600.0;
  latency_ms_ = kDefaultLatencyMs;
  frames_ = 0;
  next_status_ = 0;
  dtr_ = false;
  rts_ = false;
}

void SimFtdi::start_of_frame() {
  ++frames_;
  uart_.pump();
}

std::optional<std::size_t> SimFtdi::control_in(const hal::UsbRequest& request, std::span<std::byte> into) {
  if (!vendor(request) || request.value != 0 || request.index > 1) return std::nullopt;
  if (request.request == kGetLatencyTimer && into.size() == 1) {
    into[0] = std::byte{latency_ms_};
    return 1;
  }
  if (request.request == kGetModemStatus && into.size() == 2) {
    into[0] = std::byte{kModemReserved | kClearToSend | kDataSetReady};
    into[1] = std::byte{kTransmitterEmpty};
    return 2;
  }
  return std::nullopt;
}

// AN232B-05, backwards: 0 and 1 stand for divisors 1 and 1.5; else whole part and eighths; nothing below 2.
bool SimFtdi::set_rate(const hal::UsbRequest& request) {
  constexpr std::uint32_t kWhole = 0x3FFF;
  const bool high_byte = facts_.release == kFt232H;
  const auto high = static_cast<std::uint32_t>(high_byte ? request.index >> 8U : request.index);
  if (high > 3 || (high_byte && (request.index & 0xFFU) > 1)) return false;
  const std::uint32_t code = request.value | high << 16U;
  const bool fast_clock = (code & kFastClockBit) != 0;
  if (fast_clock && !fast(facts_.release)) return false;
  const std::uint32_t coded = code & (kFastClockBit - 1);
  double divisor = 0.0;
  if (coded == 0) {
    divisor = 1.0;
  } else if (coded == 1) {
    divisor = 1.5;
  } else {
    const auto* const eighths = std::find(std::begin(kEighths), std::end(kEighths), coded >> kEighthsShift);
    divisor = coded % (kWhole + 1) + static_cast<double>(eighths - std::begin(kEighths)) / 8.0;
    if (divisor < 2.0) return false;
  }
  baud_ = (fast_clock ? kFastClock : kClock) / divisor;
  settings_.baud = static_cast<std::uint32_t>(std::lround(baud_));
  return true;
}

bool SimFtdi::set_format(std::uint16_t value) {
  constexpr unsigned kFields = 7;
  const unsigned bits = value & 0xFFU;
  const unsigned parity = value >> kParityShift & kFields;
  const unsigned stop = value >> kStopShift & kFields;
  if ((bits != 7 && bits != 8) || parity > kEven || (stop != kOneStop && stop != kTwoStop) ||
      value >> 14U != 0)
    return false;
  settings_.data_bits = static_cast<std::uint8_t>(bits);
  settings_.parity = parity == kNoParity ? hal::Parity::none
                     : parity == kOdd    ? hal::Parity::odd
                                         : hal::Parity::even;
  settings_.stop_bits = stop == kTwoStop ? 2 : 1;
  return true;
}

// The high byte says which of the two lines are meant, the low byte their levels.
bool SimFtdi::set_modem(std::uint16_t value) {
  constexpr unsigned kDtr = 1;
  constexpr unsigned kRts = 2;
  const unsigned meant = value >> 8U;
  if (meant == 0 || meant > (kDtr | kRts) || (value & 0xFFU & ~meant) != 0) return false;
  if ((meant & kRts) != 0) rts_ = (value & kRts) != 0;
  if ((meant & kDtr) != 0) {
    dtr_ = (value & kDtr) != 0;
    uart_.set_dtr(dtr_);
  }
  return true;
}

bool SimFtdi::control_out(const hal::UsbRequest& request, std::span<const std::byte> bytes) {
  if (!vendor(request) || !bytes.empty()) return false;
  if (request.request == kSetBaudRate) return set_rate(request);
  if (request.request == kSetFlowControl) {
    if (request.value != 0 || (request.index & ~(kRtsCts | 1U)) != 0) return false;
    settings_.flow = (request.index & kRtsCts) != 0 ? hal::FlowControl::hardware : hal::FlowControl::none;
    return true;
  }
  if (request.index > 1) return false;
  switch (request.request) {
    case kReset:
      if (request.value > kPurgeSending) return false;
      if (request.value != kPurgeSending) uart_.clear_received();
      if (request.value != kPurgeReceived) uart_.clear_sending();
      return true;
    case kSetData:
      return set_format(request.value);
    case kSetModemControl:
      return set_modem(request.value);
    case kSetLatencyTimer:
      if (request.value < 1 || request.value > 255) return false;
      latency_ms_ = static_cast<std::uint8_t>(request.value);
      return true;
    default:
      return false;
  }
}

SimUsbAnswer SimFtdi::packet_out(std::uint8_t endpoint, std::span<const std::byte> packet) {
  if (endpoint != kOut || packet.size() > packet_bytes_) return SimUsbAnswer::stall;
  return uart_.put(packet) ? SimUsbAnswer::ack : SimUsbAnswer::nak;
}

std::uint8_t SimFtdi::line_status() {
  constexpr double kTolerance = 0.05;
  auto status = static_cast<std::uint8_t>(std::exchange(next_status_, std::uint8_t{0}) |
                                          (uart_.sent() ? kTransmitterEmpty : 0U));
  if (far_baud_ > 0.0 && uart_.waiting() > 0 && std::abs(baud_ / far_baud_ - 1.0) > kTolerance)
    status |= kFramingError;
  return status;
}

SimUsbPacket SimFtdi::packet_in(std::uint8_t endpoint, std::span<std::byte> into) {
  if (endpoint != kIn) return {SimUsbAnswer::stall};
  uart_.pump();
  const std::size_t room = packet_bytes_ - kStatusBytes;
  if (uart_.waiting() < room && frames_ < latency_ms_) return {};
  frames_ = 0;
  into[0] = std::byte{kModemReserved | kClearToSend | kDataSetReady};
  into[1] = std::byte{line_status()};
  return {SimUsbAnswer::ack, kStatusBytes + uart_.take(into.subspan(kStatusBytes, room))};
}

}  // namespace forager::mocks
