#pragma once

#include <memory>

#include "hal/time.hpp"

namespace forager::hal {

// CLOCK_MONOTONIC. With speed 1 an Instant is that clock's value; otherwise time runs `speed` times as fast
// from the moment of construction on, for emulated devices faster than real time. speed must be positive and
// finite; anything else counts as 1.
[[nodiscard]] std::unique_ptr<Clock> make_steady_clock(double speed = 1.0);

}  // namespace forager::hal
