#pragma once

#include <memory>

#include "boards/board.hpp"
#include "hal/byte_stream.hpp"

namespace forager::boards {

// The line to the autopilot that the board file names: UDP, or a serial port. Closed until its open().
[[nodiscard]] std::unique_ptr<hal::ByteStream> open_autopilot_line(const Board& board);

}  // namespace forager::boards
