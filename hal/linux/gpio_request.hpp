#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "hal/linux/gpio.hpp"

namespace forager::hal {

// What both generations of libgpiod do alike: names, arguments, and the search for a line.

inline constexpr std::size_t kMostGpioLines = 64;  // of one request
inline constexpr int kMostGpioChips = 64;          // of one machine

[[nodiscard]] std::string gpio_chip_path(int number);
// Where a chip named by its path or as "gpiochip0" is; empty for a label.
[[nodiscard]] std::string gpio_chip_path(const std::string& wanted);

// "gpio pinctrl-bcm2711/GPIO17+GPIO27".
[[nodiscard]] std::string gpio_name(const std::vector<GpioLineConfig>& lines);

// Errors: invalid_argument (no line, too many, or they differ in what a request has once).
[[nodiscard]] Result<> check_gpio_group(const std::vector<GpioLineConfig>& lines);
// Errors: invalid_argument (opened for edges, configured without).
[[nodiscard]] Result<> check_gpio_edges(const GpioLineConfig& config);

// The offset of a line given by number or name, among the chip's `count`. Errors: invalid_argument (a number
// the chip does not have, two lines of that name), not_present, and those of name_of.
[[nodiscard]] Result<unsigned> find_gpio_line(const GpioLineConfig& wanted, std::size_t count,
                                              const std::function<Result<std::string>(unsigned)>& name_of);

}  // namespace forager::hal
