#pragma once

#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace forager::hal {

// What both generations of libgpiod have in common: how their errno reads. `holder` is who has a busy line.
[[nodiscard]] Failure gpio_failure(std::string_view device, std::string_view operation, int error,
                                   std::string_view holder = {});

// The number of a line given as one ("17"); -1 for a name.
[[nodiscard]] long gpio_line_number(const std::string& line);

}  // namespace forager::hal
