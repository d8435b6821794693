#pragma once

#include <optional>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {
class Kernel;
}

namespace forager::boards {

// Which outputs of a board file a program moves.
struct OutputScope {
  bool brakes = false;
  bool escs = false;
  bool reader = false;  // its radio and its lamp
  // The one output of a bench command, named by the board file or not.
  std::optional<BenchLine> line{};    // safe: inactive; one that is to keep its level is left alone
  std::optional<PwmPlace> pulses{};   // safe: none
  std::optional<BenchServo> servo{};  // safe: its safe place, held or released as it says
};

// Whether one of them is real: only that needs somebody who makes it safe.
[[nodiscard]] bool has_real_outputs(const Board& board, const OutputScope& scope);

// What became of one output.
struct SafeOutput {
  std::string output;               // "left brake (pwm pwmchip0/0)"
  std::optional<hal::Error> error;  // nothing: it was told, and took it
};

// Puts every real output of the scope into its safe state: brakes locked, ESCs on their stop pulse, the
// reader silent and its lamp off, a bench command's output as OutputScope says. For when the program that
// moved them is gone. Opens whatever it needs, each output by itself: one that fails keeps no other from
// being locked. The quick ones (PWM, lines, I2C) come before those on slow lines (Modbus, the autopilot and
// the reader, which are waited for 3 s each). What fails is tried again for a second: the kernel takes a
// moment to free what a dead process held.
//
// Where pulses are made by software they go on for two seconds, in which a servo gets to its place; then they
// end. Chips and kernel timers go on with the last pulse. Returns one entry for each output, the quick ones
// first.
[[nodiscard]] std::vector<SafeOutput> make_outputs_safe(const Board& board, const OutputScope& scope,
                                                        hal::Clock& clock, hal::Kernel* kernel = nullptr);

}  // namespace forager::boards
