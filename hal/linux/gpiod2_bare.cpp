// libgpiod 2. Twins: gpiod1_bare.cpp, absent_gpiod_bare.cpp.
#include <gpiod.h>

#include <cerrno>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/gpio.hpp"
#include "hal/linux/gpio_error.hpp"

namespace forager::hal {
namespace {

// Null: errno says why.
std::shared_ptr<gpiod_line_request> request(const std::string& path, unsigned line) {
  const std::shared_ptr<gpiod_line_settings> settings(gpiod_line_settings_new(), gpiod_line_settings_free);
  const std::shared_ptr<gpiod_line_config> lines(gpiod_line_config_new(), gpiod_line_config_free);
  gpiod_chip* const chip = gpiod_chip_open(path.c_str());
  gpiod_line_request* made = nullptr;
  if (chip != nullptr && settings && lines) {
    gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
    if (gpiod_line_config_add_line_settings(lines.get(), &line, 1, settings.get()) == 0)
      made = gpiod_chip_request_lines(chip, nullptr, lines.get());
  }
  const int error = errno;
  if (chip != nullptr) gpiod_chip_close(chip);
  errno = error;
  // Left inactive, whatever was set last.
  return {made, [line](gpiod_line_request* held) {
            if (held == nullptr) return;
            gpiod_line_request_set_value(held, line, GPIOD_LINE_VALUE_INACTIVE);
            gpiod_line_request_release(held);
          }};
}

}  // namespace

Result<CallLoop> open_bare_gpio(const std::string& chip, unsigned line) {
  const std::string name = "gpio " + chip + "/" + std::to_string(line);
  const auto held = request(chip, line);
  if (!held) return gpio_failure(name, "open", errno);
  const auto run = [held, line, name](std::uint64_t calls) -> Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i) {
      const auto value = (i & 1U) == 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
      if (gpiod_line_request_set_value(held.get(), line, value) != 0) return gpio_failure(name, "set", errno);
    }
    return calls;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
