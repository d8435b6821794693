#include "hal/hid_device.hpp"

#include <fmt/format.h>

namespace forager::hal {

Result<> HidDevice::check(std::size_t bytes, std::string_view operation) const {
  constexpr std::size_t kMost = 16384;  // the kernel's HID_MAX_BUFFER_SIZE
  if (bytes > 0 && bytes <= kMost) return {};
  return failed(ErrorCode::invalid_argument, std::string(operation),
                fmt::format("{} bytes: a report has 1 to {}", bytes, kMost));
}

Result<std::size_t> HidDevice::read(std::span<std::byte> into, Duration at_most) {
  if (auto checked = check(into.size(), "read"); !checked) return fail(std::move(checked).error());
  if (at_most <= Duration::zero())
    return failed(ErrorCode::invalid_argument, "read", "a positive time is needed to wait");
  auto got = do_read(into, at_most);
  if (got && *got == 0)
    return failed(ErrorCode::timeout, "read",
                  fmt::format("no report within {} ms", at_most / std::chrono::milliseconds(1)));
  return got;
}

Result<std::size_t> HidDevice::poll(std::span<std::byte> into) {
  if (auto checked = check(into.size(), "read"); !checked) return fail(std::move(checked).error());
  return do_read(into, Duration::zero());
}

Result<> HidDevice::write(std::span<const std::byte> report) {
  FORAGER_TRY(check(report.size(), "write"));
  return do_write(report);
}

Result<std::size_t> HidDevice::get_feature(std::span<std::byte> into) {
  if (auto checked = check(into.size(), "get feature report"); !checked)
    return fail(std::move(checked).error());
  return do_get_feature(into);
}

Result<> HidDevice::send_feature(std::span<const std::byte> report) {
  FORAGER_TRY(check(report.size(), "send feature report"));
  return do_send_feature(report);
}

}  // namespace forager::hal
