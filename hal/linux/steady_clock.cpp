#include "hal/linux/steady_clock.hpp"

#include <cerrno>
#include <cmath>
#include <ctime>

namespace forager::hal {

namespace {

Duration monotonic() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

Duration scaled(Duration span, double factor) {
  // Exact in real time, where the detour over double would round after 104 days.
  return factor == 1.0 ? span : from_seconds(to_seconds(span) * factor);
}

class SteadyClock final : public Clock {
 public:
  explicit SteadyClock(double speed)
      : speed_(std::isfinite(speed) && speed > 0.0 ? speed : 1.0), start_(monotonic()) {}

 private:
  Instant do_now() const override { return Instant(start_ + scaled(monotonic() - start_, speed_)); }

  void do_sleep_until(Instant when) override {
    const Duration wanted = start_ + scaled(when.time_since_epoch() - start_, 1.0 / speed_);
    const auto seconds = std::chrono::floor<std::chrono::seconds>(wanted);
    const timespec target{static_cast<time_t>(seconds.count()),
                          static_cast<long>((wanted - seconds).count())};
    if (wanted <= Duration::zero()) return;
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &target, nullptr) == EINTR) {
    }
  }

  double speed_;
  Duration start_;
};

}  // namespace

std::unique_ptr<Clock> make_steady_clock(double speed) { return std::make_unique<SteadyClock>(speed); }

}  // namespace forager::hal
