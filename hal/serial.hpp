#pragma once

#include <cstdint>
#include <string>

#include "hal/byte_stream.hpp"

namespace forager::hal {

enum class Parity : std::uint8_t { none, even, odd };
enum class FlowControl : std::uint8_t { none, hardware };  // hardware: RTS and CTS

// How bytes travel on a serial line. Both ends must agree: nothing on the wire tells.
struct SerialSettings {
  std::uint32_t baud = 115200;
  std::uint8_t data_bits = 8;  // 5 to 8
  Parity parity = Parity::none;
  std::uint8_t stop_bits = 1;  // 1 or 2
  FlowControl flow = FlowControl::none;
};

// "115200 8N1", "57600 8E1 rts/cts".
[[nodiscard]] std::string to_string(const SerialSettings& settings);

// Errors: invalid_argument, for settings that no line can have.
[[nodiscard]] Result<> check(const SerialSettings& settings, std::string_view device);

// A serial line, whether the kernel drives the adapter or this process does. There is no telling from the
// line whether anybody is at its other end: an open port stays open when the far device is switched off, and
// only goes when the adapter does (disconnected). A byte with the wrong parity or a broken stop bit is left
// out; the protocol above sees it missing.
class SerialPort : public ByteStream {
 public:
  // What the line really has: the baud rate is the one the adapter's divider comes to. As asked while closed.
  [[nodiscard]] virtual SerialSettings line() const = 0;
};

}  // namespace forager::hal
