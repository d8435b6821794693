#pragma once

#include <fcntl.h>
#include <linux/gpio.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "hal/time.hpp"

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

inline void drop_oldest(int event_pipe) {
  const int reading = ::open(("/proc/self/fd/" + std::to_string(event_pipe)).c_str(), O_RDONLY | O_NONBLOCK);
  gpio_v2_line_event oldest{};
  static_cast<void>(!::read(reading, &oldest, sizeof oldest));
  ::close(reading);
}

inline std::uint64_t wall_minus_monotonic() {
  timespec wall{};
  timespec monotonic{};
  clock_gettime(CLOCK_REALTIME, &wall);
  clock_gettime(CLOCK_MONOTONIC, &monotonic);
  return static_cast<std::uint64_t>((wall.tv_sec - monotonic.tv_sec) * 1'000'000'000 + wall.tv_nsec -
                                    monotonic.tv_nsec);
}

inline Instant monotonic_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return Instant(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
}

inline bool is_active(const GpioLine& line) {
  return line.level != ((line.flags & GPIOLINE_FLAG_ACTIVE_LOW) != 0);
}

}  // namespace forager::hal::fake
