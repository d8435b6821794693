#include "mocks/sim_mcp2221.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace forager::mocks {

using namespace hal::mcp2221;

namespace {

constexpr std::uint8_t kDividerReset = 117;  // 100 kHz
// Factory settings (DS20005565, register 1-5 to 1-8): GP0 SSPND, GP1 clock out, GP2 USBCFG, GP3 LED of I2C.
constexpr std::array<std::uint8_t, kPins> kPinsReset{0x02, 0x01, 0x01, 0x01};
constexpr std::array<std::uint8_t, 34> kDescriptor{
    0x06, 0x00, 0xFF,                          // usage page: vendor 0xFF00
    0x09, 0x01, 0xA1, 0x01,                    // usage 1, collection: application
    0x09, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00,  // usage 1, logical 0 to 255
    0x75, 0x08, 0x95, 0x40, 0x81, 0x02,        // 64 of 8 bits: input
    0x09, 0x02, 0x15, 0x00, 0x26, 0xFF, 0x00,  // usage 2, logical 0 to 255
    0x75, 0x08, 0x95, 0x40, 0x91, 0x02,        // 64 of 8 bits: output
    0xC0};

std::uint8_t byte_at(std::span<const std::byte> report, std::size_t at) {
  return std::to_integer<std::uint8_t>(report[at]);
}

}  // namespace

SimMcp2221::SimMcp2221(hal::I2c& bus, std::string serial, std::string path)
    : bus_(&bus),
      facts_{.vendor = kVendor,
             .product = kProduct,
             .serial = std::move(serial),
             .manufacturer = "Microchip Technology Inc.",
             .product_name = "MCP2221 USB-I2C/UART Combo",
             .path = std::move(path),
             .usage_page = 0xFF00,
             .usage = 1,
             .interface_number = 2,
             .driver = "hid-generic"} {
  power(true);
}

std::span<const std::uint8_t> SimMcp2221::report_descriptor() const { return kDescriptor; }

void SimMcp2221::power(bool) {
  answers_.clear();
  pins_ = kPinsReset;
  divider_ = kDividerReset;
  reset_engine();
}

void SimMcp2221::reset_engine() {
  engine_ = kIdle;
  refused_ = false;
  pending_ = 0;
  length_ = 0;
  sending_.clear();
  received_.clear();
}

bool SimMcp2221::is_output(std::size_t pin) const { return (pins_.at(pin) & (kPinUse | kPinInput)) == 0; }

bool SimMcp2221::level(std::size_t pin) const {
  return is_output(pin) ? (pins_.at(pin) & kPinHigh) != 0 : outside_.at(pin);
}

std::uint32_t SimMcp2221::i2c_hz() const { return kClockHz / (divider_ + kDividerOffset); }

bool SimMcp2221::output(std::span<const std::byte> report) {
  if (report.size() < 2 || report.size() > kReportBytes + 1 || report[0] != std::byte{0}) return false;
  if (hung_) return true;
  Report request{};
  std::copy(report.begin() + 1, report.end(), request.begin());
  Report answer{};
  answer[0] = request[0];
  switch (byte_at(request, 0)) {
    case kStatus:
      status(request, answer);
      break;
    case kSetGpio:
      set_gpio(request, answer);
      break;
    case kGetGpio:
      get_gpio(answer);
      break;
    case kSetSram:
      set_sram(request, answer);
      break;
    case kGetSram:
      get_sram(answer);
      break;
    case kWrite:
    case kWriteNoStop:
      write(request, answer);
      break;
    case kRead:
    case kReadRepeatedStart:
      read(request, answer);
      break;
    case kReadData:
      fetch(answer);
      break;
    default:
      answer[1] = std::byte{kBusyOrUnknown};
      violation(fmt::format("command 0x{:02x} is not declared", byte_at(request, 0)));
  }
  answers_.push(answer);
  return true;
}

void SimMcp2221::status(const Report& request, Report& answer) {
  if (byte_at(request, kCancelAt) == kCancel) {
    const bool idle = engine_ == kIdle && pending_ == 0;
    answer[kCancelAt] = std::byte{idle ? kCancelIdle : kCancel};
    reset_engine();
  }
  if (byte_at(request, kSetSpeedAt) == kSetSpeed) {
    const bool moving = pending_ > 0 || held_;
    answer[kSetSpeedAt] = std::byte{moving ? kSpeedRefused : kSetSpeed};
    if (!moving) divider_ = byte_at(request, kDividerAt);
    answer[kDividerAt] = request[kDividerAt];
  }
  if (pending_ > 0) --pending_;
  answer[kEngineAt] = std::byte{pending_ > 0 ? kPartialData : engine_};
  answer[14] = std::byte{divider_};
  if (pending_ == 0 && refused_) answer[kAcknowledgeAt] = std::byte{kNotAcknowledged};
  answer[kSclAt] = std::byte{!held_};
  answer[kSdaAt] = std::byte{1};
  constexpr std::string_view kVersion = "A612";
  std::transform(kVersion.begin(), kVersion.end(), answer.begin() + kHardwareAt,
                 [](char letter) { return static_cast<std::byte>(letter); });
}

void SimMcp2221::set_gpio(const Report& request, Report& answer) {
  for (std::size_t pin = 0; pin < kPins; ++pin) {
    const std::size_t at = kPinAt + 4 * pin;
    if ((pins_[pin] & kPinUse) != 0) {
      std::fill_n(answer.begin() + static_cast<std::ptrdiff_t>(at), 4, std::byte{kNotGpioLevel});
      continue;
    }
    std::copy_n(request.begin() + static_cast<std::ptrdiff_t>(at), 4,
                answer.begin() + static_cast<std::ptrdiff_t>(at));
    const auto set = [&](std::uint8_t bit, bool on) {
      pins_[pin] = static_cast<std::uint8_t>(on ? pins_[pin] | bit : pins_[pin] & ~bit);
    };
    if (byte_at(request, at) != 0) set(kPinHigh, byte_at(request, at + 1) != 0);
    if (byte_at(request, at + 2) != 0) set(kPinInput, byte_at(request, at + 3) != 0);
  }
}

void SimMcp2221::get_gpio(Report& answer) const {
  for (std::size_t pin = 0; pin < kPins; ++pin) {
    const bool gpio = (pins_[pin] & kPinUse) == 0;
    answer[kPinAt + 2 * pin] = gpio ? std::byte{level(pin)} : std::byte{kNotGpioLevel};
    answer[kPinAt + 2 * pin + 1] =
        !gpio ? std::byte{kNotGpioDirection} : std::byte{is_output(pin) ? std::uint8_t{0} : kInput};
  }
}

void SimMcp2221::set_sram(const Report& request, Report& answer) {
  for (std::size_t at = 2; at < kAlterPinsAt; ++at)
    if (byte_at(request, at) != 0) violation(fmt::format("SRAM byte {} is not declared", at));
  if (byte_at(request, kAlterPinsAt) != kAlterPins) return;
  for (std::size_t pin = 0; pin < kPins; ++pin) {
    const std::uint8_t value = byte_at(request, kSetPinsAt + pin);
    if ((value & ~(kPinHigh | kPinInput | kPinUse)) != 0) {
      violation(fmt::format("reserved bits of GP{}", pin));
      answer[1] = std::byte{kBusyOrUnknown};
      return;
    }
    pins_[pin] = value;
  }
}

void SimMcp2221::get_sram(Report& answer) const {
  answer[2] = std::byte{18};  // bytes of chip settings
  answer[3] = std::byte{kPins};
  for (std::size_t pin = 0; pin < kPins; ++pin) answer[kGetPinsAt + pin] = std::byte{pins_[pin]};
}

void SimMcp2221::write(const Report& request, Report& answer) {
  const std::size_t length = byte_at(request, 1) | static_cast<std::size_t>(byte_at(request, 2)) << 8U;
  const bool goes_on = length_ != 0;
  const bool ready = engine_ == kIdle && pending_ == 0;
  if (!ready || (goes_on && length != length_)) {
    answer[1] = std::byte{kBusyOrUnknown};
    answer[2] = std::byte{engine_};
    return;
  }
  if (length == 0 || (byte_at(request, 3) & 1U) != 0) {
    violation("a write of nothing, or to an address with the read bit");
    answer[1] = std::byte{kBusyOrUnknown};
    return;
  }
  address_ = static_cast<std::uint8_t>(byte_at(request, 3) >> 1U);
  length_ = length;
  const std::size_t piece = std::min(kDataBytes, length - sending_.size());
  sending_.insert(sending_.end(), request.begin() + kDataAt,
                  request.begin() + static_cast<std::ptrdiff_t>(kDataAt + piece));
  if (sending_.size() < length) return;
  length_ = 0;
  run(byte_at(request, 0) == kWrite);
}

void SimMcp2221::run(bool stop) {
  pending_ = slowness_;
  if (held_) {
    engine_ = kStartTimeout;
    return;
  }
  if (!stop) {  // goes out together with the read that follows
    engine_ = kNoStopDone;
    return;
  }
  const auto written = bus_->write(address_, sending_);
  sending_.clear();
  refused_ = !written.has_value();
  engine_ = refused_ ? kAddressRefused : kIdle;
}

void SimMcp2221::read(const Report& request, Report& answer) {
  const bool repeated = byte_at(request, 0) == kReadRepeatedStart;
  const std::size_t length = byte_at(request, 1) | static_cast<std::size_t>(byte_at(request, 2)) << 8U;
  if (pending_ > 0) --pending_;  // it has had its time meanwhile, as if it had been asked
  if (pending_ > 0 || engine_ != (repeated ? kNoStopDone : kIdle)) {
    answer[1] = std::byte{kBusyOrUnknown};
    answer[2] = std::byte{engine_};
    return;
  }
  // The command itself says which way; Linux's driver leaves the bit for reading away.
  if (length == 0) {
    violation("a read of nothing");
    answer[1] = std::byte{kBusyOrUnknown};
    return;
  }
  pending_ = slowness_;
  if (held_) {
    engine_ = kStartTimeout;
    return;
  }
  received_.resize(length);
  const auto address = static_cast<std::uint8_t>(byte_at(request, 3) >> 1U);
  const auto got = repeated ? bus_->write_read(address, sending_, received_) : bus_->read(address, received_);
  sending_.clear();
  refused_ = !got.has_value();
  engine_ = refused_ ? kAddressRefused : kReadComplete;
  if (refused_) received_.clear();
}

void SimMcp2221::fetch(Report& answer) {
  if (pending_ > 0) --pending_;
  if (pending_ > 0) {
    answer[1] = std::byte{kNotYet};
    answer[3] = std::byte{kReadFailed};
    return;
  }
  answer[2] = std::byte{engine_};
  if (engine_ != kReadComplete) return;
  const std::size_t count = std::min(kDataBytes, received_.size());
  answer[2] = std::byte{count < received_.size() ? kReadPartial : kReadComplete};
  answer[3] = static_cast<std::byte>(count);
  std::copy_n(received_.begin(), count, answer.begin() + kDataAt);
  received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(count));
  if (received_.empty()) engine_ = kIdle;
}

}  // namespace forager::mocks
