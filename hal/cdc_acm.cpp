#include "hal/cdc_acm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "hal/cdc_acm_wire.hpp"

namespace forager::hal {
namespace {

using namespace cdc_acm;

using LineCoding = std::array<std::byte, kLineCodingBytes>;

LineCoding encode(const SerialSettings& line) {
  LineCoding coding{};
  for (std::size_t i = 0; i < sizeof line.baud; ++i) coding[i] = static_cast<std::byte>(line.baud >> 8 * i);
  const auto parity = line.parity == Parity::none ? kNoParity : line.parity == Parity::odd ? kOdd : kEven;
  coding[kStopAt] = std::byte{line.stop_bits == 2 ? kTwoStop : kOneStop};
  coding[kParityAt] = std::byte{parity};
  coding[kDataBitsAt] = std::byte{line.data_bits};
  return coding;
}

std::uint32_t baud_of(const LineCoding& coding) {
  std::uint32_t baud = 0;
  for (std::size_t i = 0; i < sizeof baud; ++i) baud |= std::to_integer<std::uint32_t>(coding[i]) << 8 * i;
  return baud;
}

class CdcAcm final : public UsbSerial {
 public:
  CdcAcm(Usb& usb, const UsbSerialConfig& config) : UsbSerial(usb, config, "cdc-acm") {}
  ~CdcAcm() override { close(); }  // while hang_up() is still ours
  CdcAcm(const CdcAcm&) = delete;
  CdcAcm& operator=(const CdcAcm&) = delete;

 private:
  Result<Endpoints> inspect() override;
  Result<bool> step(std::size_t index) override;
  void hang_up() override { static_cast<void>(set_control_lines(0)); }

  [[nodiscard]] UsbRequest request(std::uint8_t number, std::uint16_t value = 0) const {
    return {UsbRequestKind::class_specific, UsbRecipient::interface, number, value, control_};
  }
  Result<> set_control_lines(std::uint16_t lines) {
    return device().control_out(request(kSetControlLineState, lines), {}, config().request_timeout);
  }
  Result<> verify();

  std::uint8_t control_ = 0;
  std::uint8_t data_ = 0;
};

// The data interface of a port is the next one of that class: so does every device with the usual descriptors
// (CDC 1.2, section 5.2.3.2 would allow others).
Result<CdcAcm::Endpoints> CdcAcm::inspect() {
  if (config().line.flow == FlowControl::hardware)
    return failed(ErrorCode::unsupported, "open", "CDC-ACM knows no RTS/CTS", "Leave flow control out");
  const auto& all = device().facts().interfaces;
  std::size_t left = config().port;
  auto control = all.begin();
  for (; control != all.end(); ++control) {
    const bool fits = control->class_code == kCommunicationClass && control->subclass == kAbstractControl;
    if (fits && left-- == 0) break;
  }
  const auto data = std::find_if(control, all.end(),
                                 [](const UsbInterfaceFacts& each) { return each.class_code == kDataClass; });
  if (data == all.end())
    return failed(ErrorCode::unsupported, "open",
                  fmt::format("the device has no CDC-ACM port {}", config().port),
                  "See its interfaces: forager usb list");
  control_ = control->number;
  data_ = data->number;
  return bulk_endpoints(data_);
}

Result<bool> CdcAcm::step(std::size_t index) {
  const auto done = [](Result<> result) { return result.map([] { return true; }); };
  const LineCoding coding = encode(config().line);
  switch (index) {
    case 0:
      return done(device().claim(control_));
    case 1:
      return done(device().claim(data_));
    case 2:
      return done(device().control_out(request(kSetLineCoding), coding, config().request_timeout));
    case 3:
      return done(verify());
    default:
      return set_control_lines(kDtr | kRts).map([] { return false; });
  }
}

Result<> CdcAcm::verify() {
  constexpr std::uint32_t kPerCent = 3;  // more, and a byte's last bits are misread
  const LineCoding wanted = encode(config().line);
  LineCoding taken{};
  const auto got = device().control_in(request(kGetLineCoding), taken, config().request_timeout);
  // A device need not tell (table 13 of PSTN 1.2 makes it optional): it is taken at its word.
  if (!got && got.error().code == ErrorCode::refused) return {};
  if (!got) return fail(got.error());
  if (*got != kLineCodingBytes)
    return failed(ErrorCode::protocol, "get line coding", fmt::format("{} bytes instead of 7", *got));
  const std::uint64_t baud = baud_of(taken);
  const std::uint64_t asked = config().line.baud;
  const std::uint64_t off = baud > asked ? baud - asked : asked - baud;
  if (off * 100 > asked * kPerCent ||
      !std::equal(taken.begin() + kStopAt, taken.end(), wanted.begin() + kStopAt))
    return failed(
        ErrorCode::unsupported, "set line coding",
        fmt::format("asked for {}, the device goes on with {} baud", to_string(config().line), baud),
        "Use a rate that the device can have");
  set_rate(static_cast<std::uint32_t>(baud));
  return {};
}

}  // namespace

std::unique_ptr<UsbSerial> make_cdc_acm(Usb& usb, const UsbSerialConfig& config) {
  return std::make_unique<CdcAcm>(usb, config);
}

}  // namespace forager::hal
