#pragma once

#include <memory>
#include <string>

#include "hal/linux/kernel.hpp"
#include "hal/serial.hpp"
#include "hal/time.hpp"

namespace forager::hal {

struct SerialPortConfig {
  std::string device = "/dev/ttyUSB0";  // better "/dev/serial/by-id/...": it stays when plugs change places
  SerialSettings line{};
  // How far the rate that the adapter's divider comes to may be off, as a fraction. Two UARTs understand each
  // other up to about 0.02 together; a CP2102N asked for 115200 runs at 115384. 0: exactly, or not at all.
  double baud_tolerance = 0.01;
  // A port just plugged in belongs to root until udev has run: for so long "no permission" is tried again.
  Duration settle = std::chrono::seconds(1);
};

// A serial port of the kernel (termios2): raw bytes, any baud rate, nobody else. Closed until open(); never
// blocks. Exclusive in both ways Linux knows, TIOCEXCL against everybody who is not root and flock() against
// those who ask (minicom, socat, another forager); a busy port's error names the process that has it, as far
// as it may be seen.
//
// open() answers at once; while "no permission" is tried again poll() says `opening`. What came before
// open(), half a frame most of the time, is thrown away. close() waits for the bytes that the kernel still
// holds, at most as long as the line needs to carry 4 kB; under hardware flow control it throws them away
// instead, for the other end may never take them.
//
// Errors, beside those of ByteStream: invalid_argument (settings no line can have), not_present (no such
// port: not plugged in, other name), permission (after `settle`: not in the group dialout), busy (held),
// unsupported (no serial port, or one that cannot have the rate, the parity or the bits: the message says
// what the kernel gave instead), disconnected (the adapter was unplugged).
[[nodiscard]] std::unique_ptr<SerialPort> open_serial_port(SerialPortConfig config, const Clock& clock,
                                                           Kernel& kernel = real_kernel());

}  // namespace forager::hal
