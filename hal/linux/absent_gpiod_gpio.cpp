#include "hal/linux/gpio.hpp"

namespace forager::hal {
namespace {

Failure absent(const std::string& device) {
  return fail(ErrorCode::unsupported, device, "open", "built without libgpiod",
              "Install libgpiod-dev and build again with -DFORAGER_WITH_GPIOD=ON");
}
std::string name_of(const GpioLineConfig& config) { return "gpio " + config.chip + "/" + config.line; }

}  // namespace

Result<std::unique_ptr<DigitalOut>> open_gpio_out(const GpioLineConfig& config) {
  return absent(name_of(config));
}
Result<std::unique_ptr<DigitalIn>> open_gpio_in(const GpioLineConfig& config) {
  return absent(name_of(config));
}
Result<std::unique_ptr<EdgeIn>> open_gpio_edges(const GpioLineConfig& config) {
  return absent(name_of(config));
}
Result<std::unique_ptr<DigitalOutGroup>> open_gpio_group(const std::vector<GpioLineConfig>& lines) {
  return absent(lines.empty() ? "gpio group" : name_of(lines.front()));
}
Result<std::vector<GpioLineFacts>> list_gpio() { return absent("gpio"); }
std::string gpio_library() { return "built without libgpiod"; }

}  // namespace forager::hal
