#include "boards/autopilot_line.hpp"

#include "hal/linux/serial_port.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/linux/udp_peer.hpp"

namespace forager::boards {

std::unique_ptr<hal::ByteStream> open_autopilot_line(const Board& board) {
  if (board.autopilot_serial.empty()) return hal::open_udp_peer(board.autopilot.host, board.autopilot.port);
  // udev takes its time whatever the time of the run does.
  static const std::unique_ptr<hal::Clock> clock = hal::make_steady_clock();
  hal::SerialPortConfig config;
  config.device = board.autopilot_serial;
  config.line = board.autopilot_line;
  return hal::open_serial_port(std::move(config), *clock);
}

}  // namespace forager::boards
