#include "hal/linux/gpio_error.hpp"

#include <fmt/format.h>

#include <charconv>

#include "hal/linux/kernel.hpp"

namespace forager::hal {

Failure gpio_failure(std::string_view device, std::string_view operation, int error,
                     std::string_view holder) {
  const ErrorCode code = code_of_device_errno(error);
  std::string detail;
  std::string mend;
  switch (code) {
    case ErrorCode::busy:
      detail = holder.empty() ? "somebody holds the line" : fmt::format("\"{}\" holds the line", holder);
      mend =
          "Stop that program, or take the overlay of that driver out; gpioinfo of the package gpiod lists "
          "all";
      break;
    case ErrorCode::permission:
      detail = "the operating system forbids it";
      mend =
          "Install boards/99-forager.rules into /etc/udev/rules.d and join the group gpio; then log in again";
      break;
    case ErrorCode::not_present:
    case ErrorCode::unsupported:
      detail = "this is no GPIO chip of this machine";
      mend = "See what there is: gpiodetect, of the package gpiod";
      break;
    case ErrorCode::disconnected:
      detail = "the chip is gone";
      mend = "Check the adapter's cable";
      break;
    case ErrorCode::invalid_argument:
      detail = "the chip cannot do that";
      mend = "Leave bias and drive out, and check the line's number";
      break;
    default:
      detail = "the chip failed";
      break;
  }
  return fail(code, std::string(device), std::string(operation), std::move(detail), std::move(mend), error);
}

long gpio_line_number(const std::string& line) {
  long number = -1;
  const char* end = line.data() + line.size();
  const auto read = std::from_chars(line.data(), end, number);
  return read.ec == std::errc() && read.ptr == end && number >= 0 ? number : -1;
}

}  // namespace forager::hal
