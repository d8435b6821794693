#include "boards/run_clock.hpp"

#include "hal/linux/steady_clock.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::boards {

std::unique_ptr<hal::Clock> make_virtual_clock() { return std::make_unique<mocks::VirtualClock>(); }

std::unique_ptr<hal::Clock> make_real_clock(double speed) { return hal::make_steady_clock(speed); }

}  // namespace forager::boards
