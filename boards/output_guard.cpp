#include "boards/output_guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <utility>

#include "boards/run_clock.hpp"
#include "hal/linux/process_guard.hpp"

namespace forager::boards {
namespace {

class Unguarded final : public OutputGuard {
 public:
  hal::Result<> arm() override { return {}; }
  hal::Result<> feed() override { return {}; }
  void hand_over() override {}
  [[nodiscard]] hal::Duration timeout() const override { return {}; }
};

class Guarded final : public OutputGuard {
 public:
  Guarded(std::unique_ptr<hal::ProcessGuard> process, hal::Duration timeout)
      : process_(std::move(process)), timeout_(timeout) {}
  hal::Result<> arm() override { return process_->arm(); }
  hal::Result<> feed() override { return process_->feed(); }
  void hand_over() override { process_->hand_over(); }
  [[nodiscard]] hal::Duration timeout() const override { return timeout_; }

 private:
  std::unique_ptr<hal::ProcessGuard> process_;
  hal::Duration timeout_;
};

// Unbuffered and in one piece: the program may have died in the middle of a line.
void say(const std::string& text) {
  const std::string line = "forager guard: " + text + "\n";
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
}

std::string what_happened(hal::GuardCause cause, hal::Duration timeout) {
  if (cause == hal::GuardCause::died) return " died";
  if (cause == hal::GuardCause::asked) return " could not end in order";
  return fmt::format(" was silent for {} ms, and was killed", timeout / std::chrono::milliseconds(1));
}

void act(const Board& board, const OutputScope& scope, const std::string& program, hal::Duration timeout,
         hal::GuardCause cause) {
  const auto outcome = make_outputs_safe(board, scope, *make_real_clock(1.0));
  say(program + what_happened(cause, timeout));
  for (const SafeOutput& output : outcome)
    say(output.output + ": " + (output.error ? "NOT SAFE: " + hal::describe(*output.error) : "safe"));
}

}  // namespace

hal::Duration guard_timeout(const Board& board, const OutputScope& scope) {
  const bool reader_only = !scope.brakes && !scope.escs && !scope.line && !scope.pulses && !scope.servo;
  if (reader_only) return std::chrono::hours(24);
  hal::Duration timeout = board.guard_timeout;
  if (scope.brakes)
    for (const BrakeLine* line : {&board.brakes.left, &board.brakes.right}) timeout += longest_wait(*line);
  return timeout;
}

hal::Result<std::unique_ptr<OutputGuard>> OutputGuard::start(const Board& board, const OutputScope& scope,
                                                             const std::string& program) {
  if (!has_real_outputs(board, scope)) return std::make_unique<Unguarded>();
  const hal::Duration timeout = guard_timeout(board, scope);
  auto process = hal::ProcessGuard::start(
      timeout, [=](hal::GuardCause cause) { act(board, scope, program, timeout, cause); });
  if (!process) return hal::fail(std::move(process).error());
  return std::make_unique<Guarded>(*std::move(process), timeout);
}

}  // namespace forager::boards
