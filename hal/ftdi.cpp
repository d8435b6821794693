#include "hal/ftdi.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "hal/ftdi_rate.hpp"
#include "hal/ftdi_wire.hpp"

namespace forager::hal {
namespace {

using namespace ftdi;

bool known(std::uint16_t release) {
  constexpr std::array kKnown{kFt232Bm, kFt2232C, kFt232R, kFt2232H, kFt4232H, kFt232H, kFtX};
  return std::find(kKnown.begin(), kKnown.end(), release) != kKnown.end();
}

bool fast(std::uint16_t release) { return release >= kFt2232H && release <= kFt232H; }

class FtdiPort final : public Ftdi {
 public:
  FtdiPort(Usb& usb, const FtdiConfig& config) : Ftdi(usb, config.usb, "ftdi"), latency_(config.latency) {}
  ~FtdiPort() override { close(); }  // while hang_up() is still ours
  FtdiPort(const FtdiPort&) = delete;
  FtdiPort& operator=(const FtdiPort&) = delete;

  [[nodiscard]] const FtdiLineErrors& errors() const override { return errors_; }

 private:
  Result<Endpoints> inspect() override;
  Result<bool> step(std::size_t index) override;
  std::size_t payload(std::span<std::byte> transfer) override {
    return ftdi_payload(transfer, packet_bytes_, errors_);
  }
  void hang_up() override {
    static_cast<void>(send(kSetModemControl, kDtrLow, line_));
    static_cast<void>(send(kSetModemControl, kRtsLow, line_));
  }

  Result<> send(std::uint8_t request, std::uint16_t value, std::uint16_t index) {
    return device().control_out({UsbRequestKind::vendor, UsbRecipient::device, request, value, index}, {},
                                config().request_timeout);
  }
  Result<> check_rate();
  Result<> set_rate_and_tell();
  [[nodiscard]] std::uint16_t data_format() const;

  Duration latency_;
  FtdiLineErrors errors_;
  FtdiRate rate_;
  std::uint16_t line_ = 0;  // which line of the chip: 0 if there is but one, else from 1
  std::uint8_t interface_ = 0;
  std::size_t packet_bytes_ = 64;
};

Result<FtdiPort::Endpoints> FtdiPort::inspect() {
  const UsbDeviceFacts& facts = device().facts();
  if (!known(facts.release))
    return failed(
        ErrorCode::unsupported, "open",
        fmt::format("chips of version {:x}.{:02x} are not known", facts.release >> 8U, facts.release & 0xFFU),
        "Use the kernel's driver and its /dev/ttyUSB");
  if (config().port >= facts.interfaces.size())
    return failed(ErrorCode::invalid_argument, "open",
                  fmt::format("line {} of a chip that has {}", config().port, facts.interfaces.size()));
  const SerialSettings& wanted = config().line;
  if (wanted.data_bits < 7)
    return failed(ErrorCode::invalid_argument, "open", "the chip has 7 and 8 data bits only");
  if (latency_ < std::chrono::milliseconds(1) || latency_ > std::chrono::milliseconds(255))
    return failed(ErrorCode::invalid_argument, "open", "the latency timer runs from 1 to 255 ms");
  const UsbInterfaceFacts& interface = facts.interfaces[config().port];
  interface_ = interface.number;
  line_ = facts.interfaces.size() > 1 ? static_cast<std::uint16_t>(config().port + 1) : std::uint16_t{0};
  for (const UsbEndpointFacts& endpoint : interface.endpoints)
    if (endpoint.in()) packet_bytes_ = endpoint.max_packet_bytes;
  rate_ = ftdi_rate(wanted.baud, fast(facts.release));
  FORAGER_TRY(check_rate());
  errors_ = {};
  return bulk_endpoints(interface_);
}

Result<> FtdiPort::check_rate() {
  constexpr double kMost = 0.03;  // more, and a byte's last bits are misread
  if (std::abs(rate_.error) <= kMost) return {};
  return failed(ErrorCode::invalid_argument, "open",
                fmt::format("the chip cannot divide its clock to {} baud: the nearest is {:.0f}",
                            config().line.baud, rate_.baud),
                "Use a rate that both ends can have");
}

// The high bits of the divisor stand beside the number of the line, where there are several (AN232B-05 knows
// single chips only; ftdi_sio of Linux has both).
Result<> FtdiPort::set_rate_and_tell() {
  const auto high = static_cast<std::uint16_t>(rate_.divisor >> 16U);
  const bool shifted = line_ != 0 || device().facts().release == kFt232H;
  const auto index = shifted ? static_cast<std::uint16_t>(high << 8U | line_) : high;
  FORAGER_TRY(send(kSetBaudRate, static_cast<std::uint16_t>(rate_.divisor & 0xFFFFU), index));
  set_rate(static_cast<std::uint32_t>(std::lround(rate_.baud)));
  return {};
}

std::uint16_t FtdiPort::data_format() const {
  const SerialSettings& wanted = config().line;
  const unsigned parity = wanted.parity == Parity::none  ? kNoParity
                          : wanted.parity == Parity::odd ? kOdd
                                                         : kEven;
  const unsigned stop = wanted.stop_bits == 2 ? kTwoStop : kOneStop;
  return static_cast<std::uint16_t>(wanted.data_bits | parity << kParityShift | stop << kStopShift);
}

Result<bool> FtdiPort::step(std::size_t index) {
  const auto more = [](Result<> result) { return result.map([] { return true; }); };
  switch (index) {
    case 0:
      return more(device().claim(interface_));
    case 1:
      return more(send(kReset, kResetAll, line_));
    case 2:
      return more(set_rate_and_tell());
    case 3:
      return more(send(kSetData, data_format(), line_));
    case 4: {
      const bool hardware = config().line.flow == FlowControl::hardware;
      return more(send(kSetFlowControl, 0, static_cast<std::uint16_t>(line_ | (hardware ? kRtsCts : 0U))));
    }
    case 5: {
      const auto ms = std::chrono::ceil<std::chrono::milliseconds>(latency_).count();
      return more(send(kSetLatencyTimer, static_cast<std::uint16_t>(ms), line_));
    }
    case 6:
      return more(send(kReset, kPurgeReceived, line_));
    case 7:
      return more(send(kSetModemControl, kDtrHigh, line_));
    default:
      return send(kSetModemControl, kRtsHigh, line_).map([] { return false; });
  }
}

}  // namespace

std::size_t ftdi_payload(std::span<std::byte> transfer, std::size_t packet_bytes, FtdiLineErrors& errors) {
  std::size_t kept = 0;
  for (std::size_t at = 0; at < transfer.size(); at += packet_bytes) {
    const std::size_t size = std::min(packet_bytes, transfer.size() - at);
    if (size < kStatusBytes) break;
    const auto status = std::to_integer<std::uint8_t>(transfer[at + 1]);
    if ((status & kOverrun) != 0) ++errors.overruns;
    if ((status & kBreak) != 0)
      ++errors.breaks;
    else if ((status & kParityError) != 0)
      ++errors.parity;
    else if ((status & kFramingError) != 0)
      ++errors.framing;
    if ((status & (kBreak | kParityError | kFramingError)) != 0) continue;
    std::memmove(transfer.data() + kept, transfer.data() + at + kStatusBytes, size - kStatusBytes);
    kept += size - kStatusBytes;
  }
  return kept;
}

std::unique_ptr<Ftdi> make_ftdi(Usb& usb, const FtdiConfig& config) {
  return std::make_unique<FtdiPort>(usb, config);
}

}  // namespace forager::hal
