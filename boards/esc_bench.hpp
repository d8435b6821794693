#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boards/esc_board.hpp"
#include "flight/esc_bank.hpp"
#include "hal/digital_out.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/pwm.hpp"
#include "hal/time.hpp"

namespace forager::hal {
class Kernel;
}

namespace forager::boards {

// What an emulated ESC does, for people.
struct EscSeen {
  std::string state;   // "armed"
  double spin = 0.0;   // share of full speed
  double stop_us = 0;  // what it takes for stop and full
  double full_us = 0;
  bool calibrated = false;  // it has learnt them in this run
};

// The outputs behind `forager esc`, emulated or real. Owns them; the bank borrows.
class EscBench {
 public:
  virtual ~EscBench() = default;
  [[nodiscard]] virtual hal::PwmGroup& group() = 0;
  [[nodiscard]] virtual std::vector<flight::EscLine> lines() = 0;
  // Null: a person connects the battery.
  [[nodiscard]] virtual hal::DigitalOut* power() = 0;
  // Lets emulated ESCs and chips live up to `now`. Errors: those of a chip; io (a chip lost its supply for a
  // moment: its pulses stopped, the ESCs stopped by themselves and must be armed anew).
  [[nodiscard]] virtual hal::Result<> advance(hal::Instant now) = 0;
  // Nothing where the ESC is real: it does not answer.
  [[nodiscard]] virtual std::optional<EscSeen> seen(std::size_t motor) const = 0;
  [[nodiscard]] virtual bool emulated() const = 0;
};

enum class EscStart : std::uint8_t {
  anew,       // a PCA9685 starts with all outputs off
  take_over,  // one that runs goes on, and so do its other outputs
};

// Emulated ones run on virtual time if `clock` does; the journal gets their signs (beeps, calibration).
// Null kernel: Linux. Errors: those of the output (not_present, permission, busy, ...).
[[nodiscard]] hal::Result<std::unique_ptr<EscBench>> open_esc_bench(const EscBoard& board, hal::Clock& clock,
                                                                    hal::Journal& journal,
                                                                    EscStart start = EscStart::anew,
                                                                    hal::Kernel* kernel = nullptr);

}  // namespace forager::boards
