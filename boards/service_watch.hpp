#pragma once

#include <memory>

#include "hal/time.hpp"

namespace forager::boards {

// What a service manager hears of a program: ready, alive, ending (boards/forager.service). Outside of a
// service nothing is said.
class ServiceWatch {
 public:
  virtual ~ServiceWatch() = default;  // says that it ends
  // From NOTIFY_SOCKET and WATCHDOG_USEC; says that it is ready.
  [[nodiscard]] static std::unique_ptr<ServiceWatch> begin();
  // To be called at every turn of the loop: a loop that hangs falls silent.
  virtual void alive(hal::Instant now) = 0;
};

}  // namespace forager::boards
