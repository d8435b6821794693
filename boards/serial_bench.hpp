#pragma once

#include <memory>
#include <string>
#include <vector>

#include "boards/bench_board.hpp"
#include "hal/serial.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// A serial port of this machine.
struct SerialFacts {
  std::string device;                // "/dev/ttyUSB0"
  std::vector<std::string> by_id{};  // "/dev/serial/by-id/usb-FTDI_...": stays when plugs change places
  std::string driver;                // "ftdi_sio"
  std::string product;               // what a USB adapter says of itself; may be empty
  std::string serial;                // its serial number; may be empty
};

// In the order of their names. Ports a driver has announced without hardware behind them (ttyS1 to ttyS31 on
// most machines) are left out. `root` is where sys/ and dev/ are.
[[nodiscard]] std::vector<SerialFacts> serial_ports(const std::string& root = "/");

// The name of a line of the board file, or the path of a port with the usual settings. Errors:
// invalid_argument (neither).
[[nodiscard]] hal::Result<BenchSerial> find_serial(const BenchBoard& board, const std::string& text);
[[nodiscard]] hal::SerialSettings settings_of(const BenchSerial& serial);

// Closed until open(). The clock must outlive it. Errors show in open(): hal/linux/serial_port.hpp.
[[nodiscard]] std::unique_ptr<hal::SerialPort> serial_line(const std::string& device,
                                                           const hal::SerialSettings& settings,
                                                           const hal::Clock& clock);

}  // namespace forager::boards
