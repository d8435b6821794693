#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace forager::hal {

using Duration = std::chrono::nanoseconds;

// The one time line of a run, in integer nanoseconds: monotonic, starting anywhere. On the robot it is
// CLOCK_MONOTONIC; off-target it is a counter that the outermost loop advances. It has no now(): below tools/
// time is an argument, never something to ask for.
struct Timeline {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<Timeline>;
  static constexpr bool is_steady = true;
};
using Instant = Timeline::time_point;

using namespace std::chrono_literals;

[[nodiscard]] constexpr double to_seconds(Duration d) { return std::chrono::duration<double>(d).count(); }
[[nodiscard]] constexpr double to_seconds(Instant t) { return to_seconds(t.time_since_epoch()); }
[[nodiscard]] constexpr std::int64_t to_milliseconds(Instant t) {
  return std::chrono::floor<std::chrono::milliseconds>(t.time_since_epoch()).count();
}
// Nearest nanosecond; saturates beyond +-292 years and maps NaN to zero.
[[nodiscard]] Duration from_seconds(double seconds);

// Source of time for the outermost loop only (tools/): real backends read CLOCK_MONOTONIC, doubles count.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] Instant now() const { return do_now(); }
  // Blocks (real time) or jumps (virtual time) until `when`; returns at once if it has passed.
  void sleep_until(Instant when) { do_sleep_until(when); }

 private:
  virtual Instant do_now() const = 0;
  virtual void do_sleep_until(Instant when) = 0;
};

// An instant by which something must have happened. Default-constructed it is disarmed and never expires;
// there is no default length anywhere: the board or scene file names every timeout.
class Deadline {
 public:
  Deadline() = default;
  Deadline(Instant now, Duration allowed) : at_(now + allowed) {}
  [[nodiscard]] bool armed() const { return at_.has_value(); }
  [[nodiscard]] bool expired(Instant now) const { return at_ && now >= *at_; }
  void disarm() { at_.reset(); }

 private:
  std::optional<Instant> at_;
};

}  // namespace forager::hal
