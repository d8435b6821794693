#pragma once

#include <span>
#include <string>
#include <vector>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::servo {

// One calibrated place of a servo: at this fraction or angle it wants this pulse.
struct PulsePoint {
  double at = 0.0;  // a fraction of the travel, or an angle in radians: whatever its user commands in
  hal::Duration pulse{};
};

// From a fraction or an angle to the pulse that brings a servo there: straight lines between calibrated
// points, monotonic, clamped to the outermost points. Exact at the points; between them rounded to the
// nearest nanosecond. Pulses are integers of 64 bits throughout: no product is formed that could overflow on
// a 32-bit machine.
class PulseMap {
 public:
  // Points in order of `at`; the pulse may rise or fall with it. Errors: invalid_argument (fewer than two
  // points, not finite, `at` not strictly rising, pulses not strictly monotonic, or outside 1 us .. 1 s).
  [[nodiscard]] static hal::Result<PulseMap> create(std::vector<PulsePoint> points);
  // Two points; the same errors.
  [[nodiscard]] static hal::Result<PulseMap> between(PulsePoint from, PulsePoint to);

  // Errors: invalid_argument (NaN). Infinities clamp like everything beyond the ends.
  [[nodiscard]] hal::Result<hal::Duration> pulse(double at) const;
  // Where a pulse leads: the inverse, clamped too.
  [[nodiscard]] double at(hal::Duration pulse) const;

  [[nodiscard]] double first() const { return points_.front().at; }
  [[nodiscard]] double last() const { return points_.back().at; }
  [[nodiscard]] std::span<const PulsePoint> points() const { return points_; }

 private:
  explicit PulseMap(std::vector<PulsePoint> points) : points_(std::move(points)) {}
  std::vector<PulsePoint> points_;
};

}  // namespace forager::servo
