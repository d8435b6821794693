#include "boards/jitter_bench.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "hal/digital_out.hpp"
#include "hal/linux/jitter.hpp"
#include "hal/linux/software_pwm.hpp"
#include "hal/linux/steady_clock.hpp"

namespace forager::boards {
namespace {

constexpr hal::Duration kPulse = std::chrono::microseconds(1500);

// What the edges were; outlives the line.
struct Scope {
  hal::Jitter pulse;
  hal::Jitter period;
};

class ScopedLine final : public hal::DigitalOut {
 public:
  ScopedLine(Scope& scope, hal::Duration period) : scope_(&scope), period_(period) {}

 private:
  hal::Result<> do_set(bool active) override {
    const hal::Instant now = clock_->now();
    if (active) {
      if (rose_) scope_->period.add(std::chrono::abs(now - *rose_ - period_));
      rose_ = now;
    } else if (active_) {
      scope_->pulse.add(std::chrono::abs(now - *rose_ - kPulse));
    }
    active_ = active;
    return {};
  }
  [[nodiscard]] std::string_view do_name() const override { return "a line that takes the time"; }

  Scope* scope_;
  hal::Duration period_;
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
  std::optional<hal::Instant> rose_;
  bool active_ = false;
};

// Threads that want every processor for themselves.
class Load {
 public:
  explicit Load(bool on) {
    const unsigned count = on ? std::max(1U, std::thread::hardware_concurrency()) : 0U;
    for (unsigned i = 0; i < count; ++i)
      threads_.emplace_back([this] {
        while (!stop_.load(std::memory_order_relaxed)) {
        }
      });
  }
  ~Load() {
    stop_.store(true, std::memory_order_relaxed);
    for (std::thread& thread : threads_) thread.join();
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

Lateness lateness_of(const hal::Jitter& jitter) {
  return {jitter.quantile(0.5), jitter.quantile(0.99), jitter.max()};
}

}  // namespace

hal::Result<JitterFigures> measure_jitter(const JitterCase& test) {
  const hal::Duration period = hal::from_seconds(1.0 / test.frequency_hz);
  Scope scope;
  std::vector<hal::SoftwarePwmLine> lines;
  lines.push_back({std::make_unique<ScopedLine>(scope, period), std::nullopt});
  auto pwm = hal::open_software_pwm(std::move(lines), {.period = period});
  if (!pwm) return hal::fail(std::move(pwm).error());
  {
    const Load load(test.loaded);
    FORAGER_TRY((*pwm)->channel(0).set_pulse(kPulse));
    const auto clock = hal::make_steady_clock();
    clock->sleep_until(clock->now() + test.time);
  }
  return JitterFigures{.pulse = lateness_of(scope.pulse),
                       .period = lateness_of(scope.period),
                       .pulses = scope.pulse.count(),
                       .missed_periods = (*pwm)->missed_periods(),
                       .facts = (*pwm)->facts().text};
}

}  // namespace forager::boards
