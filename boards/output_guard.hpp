#pragma once

#include <memory>
#include <string>

#include "boards/board.hpp"
#include "boards/guard_outputs.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// Watches over a program that moves real outputs, from a process of its own: when the program is killed, or
// hangs for longer than the board file's guard_timeout_ms, every output of the scope is put into its safe
// state (make_outputs_safe), and stderr says so. A program without real outputs gets none.
class OutputGuard {
 public:
  virtual ~OutputGuard() = default;  // stands down: the program has made everything safe by itself

  // Forks: to be called before devices are opened. `program` is what the messages call it. Errors: io (no
  // more processes).
  [[nodiscard]] static hal::Result<std::unique_ptr<OutputGuard>> start(const Board& board,
                                                                       const OutputScope& scope,
                                                                       const std::string& program);

  // From here on something may move: death and silence count. Errors: as feed().
  [[nodiscard]] virtual hal::Result<> arm() = 0;
  // To be called at every turn of the loop. Errors: disconnected (the guard is gone: stop).
  [[nodiscard]] virtual hal::Result<> feed() = 0;
  // The program could not make its output safe: the guard tries for a second more, and stderr says what came
  // of it. To be called when the program has closed the output.
  virtual void hand_over() = 0;
  // Zero: nothing real is moved, nobody watches.
  [[nodiscard]] virtual hal::Duration timeout() const = 0;
};

// How long a loop that moves these outputs may take at most: the board file's guard_timeout_ms, and the
// time-outs of slow lines on top, which a loop legally waits for. Where there is nothing but a reader, which
// is no danger while a loop is late, only death counts: a day.
[[nodiscard]] hal::Duration guard_timeout(const Board& board, const OutputScope& scope);

}  // namespace forager::boards
