#include "mocks/sim_linear_actuator.hpp"

#include <algorithm>
#include <cmath>

namespace forager::mocks {
namespace {

constexpr double kStepsPerMm = 10.0;

}  // namespace

SimLinearActuator::SimLinearActuator(const Options& options)
    : options_(options),
      slave_(options.unit, SimModbusSlave::Framing::rtu),
      position_mm_(options.safe_target / kStepsPerMm) {
  slave_.holding[kTarget] = options.safe_target;
  slave_.input[kPosition] = options.safe_target;
  slave_.coils[kEnable] = false;
}

void SimLinearActuator::update(hal::Instant now) {
  if (!spoken_to_ || heard_ != slave_.requests) spoken_to_ = now;
  heard_ = slave_.requests;
  if (now - *spoken_to_ > options_.watchdog) slave_.holding[kTarget] = options_.safe_target;
  const double passed_s = last_ ? hal::to_seconds(now - *last_) : 0.0;
  last_ = now;
  if (slave_.coils[kEnable] && !jammed) {
    const double target = std::min(slave_.holding[kTarget] / kStepsPerMm, options_.stroke_mm);
    const double step = options_.speed_mm_s * passed_s;
    position_mm_ = std::clamp(target, position_mm_ - step, position_mm_ + step);
  }
  slave_.input[kPosition] = static_cast<std::uint16_t>(std::lround(position_mm_ * kStepsPerMm));
}

}  // namespace forager::mocks
