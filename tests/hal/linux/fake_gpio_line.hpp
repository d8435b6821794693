#pragma once

#include <linux/gpio.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace forager::hal::fake {

struct GpioLine {
  std::string name;
  std::string consumer{};   // empty: free
  bool level = false;       // at the pin
  std::uint32_t flags = 0;  // GPIOLINE_FLAG_*
  int event_pipe = -1;      // where edges of whoever asked for them go
  bool used = false;
  bool v2_events = false;       // as struct gpio_v2_line_event
  int wired_to = -1;            // a line of the same chip that takes this one's level when it is set
  std::vector<bool> history{};  // levels that were driven by an output, in order
};

// One property of a line in the three languages of linux/gpio.h.
struct FlagPair {
  std::uint64_t v2;
  std::uint32_t asked;  // GPIOHANDLE_REQUEST_*
  std::uint32_t shown;  // GPIOLINE_FLAG_*
};
inline constexpr std::array kFlags{
    FlagPair{GPIO_V2_LINE_FLAG_INPUT, GPIOHANDLE_REQUEST_INPUT, 0},
    FlagPair{GPIO_V2_LINE_FLAG_OUTPUT, GPIOHANDLE_REQUEST_OUTPUT, GPIOLINE_FLAG_IS_OUT},
    FlagPair{GPIO_V2_LINE_FLAG_ACTIVE_LOW, GPIOHANDLE_REQUEST_ACTIVE_LOW, GPIOLINE_FLAG_ACTIVE_LOW},
    FlagPair{GPIO_V2_LINE_FLAG_OPEN_DRAIN, GPIOHANDLE_REQUEST_OPEN_DRAIN, GPIOLINE_FLAG_OPEN_DRAIN},
    FlagPair{GPIO_V2_LINE_FLAG_OPEN_SOURCE, GPIOHANDLE_REQUEST_OPEN_SOURCE, GPIOLINE_FLAG_OPEN_SOURCE},
    FlagPair{GPIO_V2_LINE_FLAG_BIAS_PULL_UP, GPIOHANDLE_REQUEST_BIAS_PULL_UP, GPIOLINE_FLAG_BIAS_PULL_UP},
    FlagPair{GPIO_V2_LINE_FLAG_BIAS_PULL_DOWN, GPIOHANDLE_REQUEST_BIAS_PULL_DOWN, 0},
    FlagPair{GPIO_V2_LINE_FLAG_BIAS_DISABLED, GPIOHANDLE_REQUEST_BIAS_DISABLE, 0}};

}  // namespace forager::hal::fake
