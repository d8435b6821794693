// libgpiod 1.6. Twins: gpiod2_bare.cpp, absent_gpiod_bare.cpp.
#include <gpiod.h>

#include <cerrno>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/gpio_error.hpp"

namespace forager::hal {

Result<CallLoop> open_bare_gpio(const std::string& chip, unsigned line) {
  const std::string name = "gpio " + chip + "/" + std::to_string(line);
  const std::shared_ptr<gpiod_chip> open(gpiod_chip_open(chip.c_str()), [](gpiod_chip* made) {
    if (made != nullptr) gpiod_chip_close(made);
  });
  if (!open) return gpio_failure(name, "open", errno);
  gpiod_line* const pin = gpiod_chip_get_line(open.get(), line);
  if (pin == nullptr || gpiod_line_request_output(pin, "forager", 0) != 0)
    return gpio_failure(name, "open", errno);
  const auto run = [open, pin, name](std::uint64_t calls) -> Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i)
      if (gpiod_line_set_value(pin, static_cast<int>(i & 1U)) != 0) return gpio_failure(name, "set", errno);
    return calls;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
