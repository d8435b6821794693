#include "hal/serial.hpp"

#include <fmt/format.h>

namespace forager::hal {
namespace {

constexpr std::uint32_t kFastest = 12'000'000;  // a high-speed FTDI adapter

char letter_of(Parity parity) {
  switch (parity) {
    case Parity::none:
      return 'N';
    case Parity::even:
      return 'E';
    case Parity::odd:
      return 'O';
  }
  return '?';
}

}  // namespace

std::string to_string(const SerialSettings& settings) {
  return fmt::format("{} {}{}{}{}", settings.baud, settings.data_bits, letter_of(settings.parity),
                     settings.stop_bits, settings.flow == FlowControl::hardware ? " rts/cts" : "");
}

Result<> check(const SerialSettings& settings, std::string_view device) {
  const auto wrong = [&](std::string what, std::string mend) {
    return fail(ErrorCode::invalid_argument, std::string(device), "open", std::move(what), std::move(mend));
  };
  if (settings.baud == 0 || settings.baud > kFastest)
    return wrong(fmt::format("{} baud is not from 1 to {}", settings.baud, kFastest),
                 "Use the rate of the device at the other end: 115200, 57600, 19200, 9600");
  if (settings.data_bits < 5 || settings.data_bits > 8)
    return wrong(fmt::format("{} data bits are not from 5 to 8", settings.data_bits), "8 is usual");
  if (settings.stop_bits < 1 || settings.stop_bits > 2)
    return wrong(fmt::format("{} stop bits are neither 1 nor 2", settings.stop_bits), "1 is usual");
  return {};
}

}  // namespace forager::hal
