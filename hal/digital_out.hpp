#pragma once

#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// One logical output: active or inactive. Polarity belongs to the board file. Safe state: inactive.
class DigitalOut {
 public:
  virtual ~DigitalOut() = default;
  // Errors: invalid_argument (no such line), permission, busy, disconnected, timeout, refused, io. A set that
  // goes over a network is queued; a later failure shows at the next set() and in the device's link state.
  [[nodiscard]] Result<> set(bool active) { return do_set(active); }
  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_set(bool active) = 0;
  virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
