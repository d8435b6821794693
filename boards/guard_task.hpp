#pragma once

#include <memory>
#include <string>
#include <vector>

#include "boards/guard_outputs.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::boards {

// A chip that had to be started takes its pulses after this.
inline constexpr hal::Duration kChipWakes = std::chrono::milliseconds(5);

// An output that is to be made safe, with all it takes (boards/guard_outputs).
class GuardTask {
 public:
  virtual ~GuardTask() = default;
  // Opens what is not open yet, and tells the output. Errors: those of the output.
  virtual hal::Result<> attempt(hal::Instant now) = 0;
  virtual void live(hal::Instant now) = 0;
  [[nodiscard]] virtual std::string name() const = 0;
  [[nodiscard]] virtual bool slow() const { return false; }
  // How long it must be kept alive after it was told.
  [[nodiscard]] virtual hal::Duration linger() const { return kChipWakes; }
};

// The single output of a bench command, where the scope has one that is real.
void add_bench_tasks(std::vector<std::unique_ptr<GuardTask>>& tasks, const OutputScope& scope,
                     hal::Journal& journal, hal::Kernel* kernel);

}  // namespace forager::boards
