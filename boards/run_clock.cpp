#include "boards/run_clock.hpp"

#include <utility>

#include "hal/linux/steady_clock.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::boards {
namespace {

// A run's times count from its own start, whatever the machine's uptime.
class FromZero final : public hal::Clock {
 public:
  explicit FromZero(std::unique_ptr<hal::Clock> clock) : clock_(std::move(clock)), zero_(clock_->now()) {}

 private:
  hal::Instant do_now() const override { return hal::Instant(clock_->now() - zero_); }
  void do_sleep_until(hal::Instant when) override { clock_->sleep_until(zero_ + when.time_since_epoch()); }

  std::unique_ptr<hal::Clock> clock_;
  hal::Instant zero_;
};

}  // namespace

std::unique_ptr<hal::Clock> make_virtual_clock() { return std::make_unique<mocks::VirtualClock>(); }

std::unique_ptr<hal::Clock> make_real_clock(double speed) {
  return std::make_unique<FromZero>(hal::make_steady_clock(speed));
}

}  // namespace forager::boards
