#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/digital_in.hpp"
#include "hal/digital_out.hpp"
#include "hal/digital_out_group.hpp"
#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

enum class GpioBias : std::uint8_t { as_is, none, pull_up, pull_down };
enum class GpioDrive : std::uint8_t { push_pull, open_drain, open_source };
enum class GpioEdges : std::uint8_t { none, both };

// What becomes of an output when its object ends. After a crash neither applies: the kernel frees the line,
// and what it then does depends on the chip; a Raspberry Pi keeps the last level, others go back to inputs.
enum class GpioAtEnd : std::uint8_t {
  inactive,  // made inactive first, then given back
  as_is,     // given back with the level it has
};

struct GpioLineConfig {
  // "pinctrl-bcm2711" (a label, the same at every boot), "gpiochip0" or "/dev/gpiochip0".
  std::string chip;
  std::string line;  // its name ("GPIO17", "BRAKE_LEFT"), or its number on the chip
  bool active_low = false;
  GpioBias bias = GpioBias::as_is;
  GpioDrive drive = GpioDrive::push_pull;  // outputs only
  GpioEdges edges = GpioEdges::none;       // inputs only
  Duration debounce{};                     // inputs only; 0: none
  bool begin_active = false;               // outputs only: requested active, without a spike
  GpioAtEnd at_end = GpioAtEnd::inactive;  // outputs only
  std::string consumer = "forager";        // what others see who ask who holds the line
};

// A line of a GPIO chip of the kernel, by libgpiod. An output is requested inactive, or active where the
// configuration says so, without a spike. Lines are held exclusively for as long as the object lives.
//
// Errors of opening: not_present (no such chip, or no line of that name), invalid_argument (two lines of that
// name; a number the chip does not have), busy (somebody holds the line: the message says who), permission,
// unsupported (built without libgpiod; the chip has no bias, or debouncing, or libgpiod is too old for it),
// io.
[[nodiscard]] Result<std::unique_ptr<DigitalOut>> open_gpio_out(const GpioLineConfig& config);
[[nodiscard]] Result<std::unique_ptr<DigitalIn>> open_gpio_in(const GpioLineConfig& config);
// With GpioEdges::none this is an invalid_argument.
[[nodiscard]] Result<std::unique_ptr<EdgeIn>> open_gpio_edges(const GpioLineConfig& config);
// All of one chip, requested together and set in one call: at most 64. Active-low, bias, drive and
// the first level are those of the first and must be the same for all.
[[nodiscard]] Result<std::unique_ptr<DigitalOutGroup>> open_gpio_group(
    const std::vector<GpioLineConfig>& lines);

struct GpioLineFacts {
  std::string chip;   // "gpiochip0"
  std::string label;  // "pinctrl-bcm2711"
  std::uint32_t number = 0;
  std::string name;     // may be empty
  std::string held_by;  // may be empty: free
  bool output = false;
  bool active_low = false;
};
// Every line of every chip that may be opened. Errors: permission (chips are there, and none may be opened),
// unsupported (built without libgpiod).
[[nodiscard]] Result<std::vector<GpioLineFacts>> list_gpio();

// "libgpiod 1.6.3", or "built without libgpiod".
[[nodiscard]] std::string gpio_library();

}  // namespace forager::hal
