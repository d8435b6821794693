#include "hal/linux/gpio_request.hpp"

#include <fmt/format.h>

#include <optional>

#include "hal/linux/gpio_error.hpp"

namespace forager::hal {

std::string gpio_chip_path(int number) { return fmt::format("/dev/gpiochip{}", number); }

std::string gpio_chip_path(const std::string& wanted) {
  if (wanted.starts_with("/dev/")) return wanted;
  return wanted.starts_with("gpiochip") ? "/dev/" + wanted : std::string();
}

std::string gpio_name(const std::vector<GpioLineConfig>& lines) {
  std::string name = fmt::format("gpio {}/{}", lines.front().chip, lines.front().line);
  for (std::size_t i = 1; i < lines.size(); ++i) name += "+" + lines[i].line;
  return name;
}

Result<> check_gpio_group(const std::vector<GpioLineConfig>& lines) {
  const auto refuse = [](std::string why) {
    return fail(ErrorCode::invalid_argument, "gpio group", "open", std::move(why));
  };
  if (lines.empty() || lines.size() > kMostGpioLines)
    return refuse(fmt::format("a group has 1 to {} lines", kMostGpioLines));
  const GpioLineConfig& first = lines.front();
  for (const GpioLineConfig& line : lines)
    if (line.chip != first.chip || line.active_low != first.active_low || line.bias != first.bias ||
        line.drive != first.drive || line.begin_active != first.begin_active)
      return refuse("the lines differ in chip, polarity, bias, drive or first level");
  return {};
}

Result<> check_gpio_edges(const GpioLineConfig& config) {
  if (config.edges != GpioEdges::none) return {};
  return fail(ErrorCode::invalid_argument, gpio_name({config}), "open",
              "edges are wanted, and none are configured");
}

Result<unsigned> find_gpio_line(const GpioLineConfig& wanted, std::size_t count,
                                const std::function<Result<std::string>(unsigned)>& name_of) {
  const std::string device = gpio_name({wanted});
  if (const long number = gpio_line_number(wanted.line); number >= 0) {
    if (static_cast<std::size_t>(number) < count) return static_cast<unsigned>(number);
    return fail(ErrorCode::invalid_argument, device, "open",
                count == 0 ? std::string("the chip has no lines")
                           : fmt::format("the chip has lines 0 to {}", count - 1));
  }
  std::optional<unsigned> found;
  for (unsigned offset = 0; offset < count; ++offset) {
    const auto name = name_of(offset);
    if (!name) return fail(name.error());
    if (*name != wanted.line) continue;
    if (found)
      return fail(ErrorCode::invalid_argument, device, "open",
                  fmt::format("lines {} and {} both have this name", *found, offset),
                  "Give the number of the line");
    found = offset;
  }
  if (found) return *found;
  return fail(ErrorCode::not_present, device, "open", "the chip has no line of this name",
              "See what there is: gpioinfo, of the package gpiod");
}

}  // namespace forager::hal
