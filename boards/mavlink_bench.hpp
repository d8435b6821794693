#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "hal/byte_stream.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// Where MAVLink is to be heard; the first that is given counts.
struct MavlinkPlace {
  std::string serial;  // a serial port, with its baud rate
  std::uint32_t baud = 57600;
  std::string listen;  // HOST:PORT to wait at
  // Else the board's autopilot.
};

// The line to an autopilot; the borrower opens it.
class MavlinkBench {
 public:
  virtual ~MavlinkBench() = default;
  [[nodiscard]] virtual hal::ByteStream& line() = 0;
  // Lets an emulated autopilot live; a real one does that by itself.
  virtual void advance(hal::Instant now) = 0;
  [[nodiscard]] virtual bool serial() const = 0;
};

// The board of kind sim has the scene's autopilot emulated in this process. The clock must outlive the bench.
// Errors: invalid_argument (address); unsupported.
[[nodiscard]] hal::Result<std::unique_ptr<MavlinkBench>> open_mavlink_bench(const Board& board,
                                                                            const Scene& scene,
                                                                            const MavlinkPlace& place,
                                                                            const hal::Clock& clock,
                                                                            std::uint64_t seed);

}  // namespace forager::boards
