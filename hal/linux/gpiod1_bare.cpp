// libgpiod 1.6. Twins: gpiod2_bare.cpp, absent_gpiod_bare.cpp.
#include <gpiod.h>

#include <cerrno>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/gpio_error.hpp"

namespace forager::hal {
namespace {

// Left inactive, whatever was set last.
struct Held {
  gpiod_chip* chip = nullptr;
  gpiod_line* pin = nullptr;

  Held() = default;
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() {
    if (pin != nullptr) gpiod_line_set_value(pin, 0);
    if (chip != nullptr) gpiod_chip_close(chip);
  }
};

}  // namespace

Result<CallLoop> open_bare_gpio(const std::string& chip, unsigned line) {
  const std::string name = "gpio " + chip + "/" + std::to_string(line);
  const auto held = std::make_shared<Held>();
  held->chip = gpiod_chip_open(chip.c_str());
  if (held->chip == nullptr) return gpio_failure(name, "open", errno);
  gpiod_line* const pin = gpiod_chip_get_line(held->chip, line);
  if (pin == nullptr || gpiod_line_request_output(pin, "forager", 0) != 0)
    return gpio_failure(name, "open", errno);
  held->pin = pin;
  const auto run = [held, pin, name](std::uint64_t calls) -> Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i)
      if (gpiod_line_set_value(pin, (i & 1U) == 0 ? 1 : 0) != 0) return gpio_failure(name, "set", errno);
    return calls;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
