#pragma once

#include <memory>
#include <string>

#include "boards/board.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"
#include "servo/brakes.hpp"

namespace forager::boards {

// The brakes of a board file on the bench, with the link to the autopilot where one of them needs it.
class BrakeBench {
 public:
  virtual ~BrakeBench() = default;
  // Lets links, chips and, once engaged, the pair live. Errors: those of the chips.
  [[nodiscard]] virtual hal::Result<> update(hal::Instant now) = 0;
  // Whether everything that was to be waited for is there: the autopilot's heartbeat.
  [[nodiscard]] virtual bool ready() const = 0;
  // Locks both: from here on brakes move. Again, once ready: with no fault known of the time before.
  virtual servo::BrakePair& engage(hal::Instant now) = 0;
  [[nodiscard]] virtual std::string left_text() const = 0;
  [[nodiscard]] virtual std::string right_text() const = 0;
};

// Errors: invalid_argument (the file has no [brakes]), and those of open_brake_devices(). The board named
// "sim" has two emulated servos. Clock and journal must outlive the bench.
[[nodiscard]] hal::Result<std::unique_ptr<BrakeBench>> open_brake_bench(const Board& board, hal::Clock& clock,
                                                                        hal::Journal& journal);

// Whether every part is emulated: then time may jump.
[[nodiscard]] bool all_emulated(const BrakeBoard& board);

}  // namespace forager::boards
