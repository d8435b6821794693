#pragma once

#include <memory>

#include "hal/time.hpp"

namespace forager::boards {

// Time that jumps to whatever is waited for: a run goes as fast as the machine allows.
[[nodiscard]] std::unique_ptr<hal::Clock> make_virtual_clock();
// CLOCK_MONOTONIC from zero, `speed` times as fast (for emulated devices; 1 for real ones).
[[nodiscard]] std::unique_ptr<hal::Clock> make_real_clock(double speed);

}  // namespace forager::boards
