#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "hal/error.hpp"
#include "hal/hid_facts.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// An open HID device. One read is one report.
//
// Errors of every call: invalid_argument (sizes; nothing was sent), disconnected (the plug is out), refused
// (the device knows no such report), permission, io.
class HidDevice {
 public:
  explicit HidDevice(HidDeviceFacts facts) : facts_(std::move(facts)), name_(describe(facts_)) {}
  virtual ~HidDevice() = default;
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;

  // The next input report; its size. The first byte is the report's number if the device has several kinds of
  // report, else its data. The kernel keeps 64 reports unread. Errors: timeout (none came), and those above.
  [[nodiscard]] Result<std::size_t> read(std::span<std::byte> into, Duration at_most);
  // As read(), at once: 0 means none is there.
  [[nodiscard]] Result<std::size_t> poll(std::span<std::byte> into);
  // An output report; the first byte is its number, 0 if the device has one kind only. Waits until the device
  // has taken it, as long as the kernel allows.
  [[nodiscard]] Result<> write(std::span<const std::byte> report);
  // into[0] is the number of the report that is asked for (0: the only one), and stays there; bytes received,
  // that one included.
  [[nodiscard]] Result<std::size_t> get_feature(std::span<std::byte> into);
  [[nodiscard]] Result<> send_feature(std::span<const std::byte> report);

  [[nodiscard]] const HidDeviceFacts& facts() const { return facts_; }
  [[nodiscard]] std::string_view name() const { return name_; }

 protected:
  [[nodiscard]] Failure failed(ErrorCode code, std::string operation, std::string detail,
                               std::string mend = {}, int sys_errno = 0) const {
    return fail(code, name_, std::move(operation), std::move(detail), std::move(mend), sys_errno);
  }

 private:
  Result<> check(std::size_t bytes, std::string_view operation) const;
  // 0: none within that time; zero time: at once.
  virtual Result<std::size_t> do_read(std::span<std::byte> into, Duration at_most) = 0;
  virtual Result<> do_write(std::span<const std::byte> report) = 0;
  virtual Result<std::size_t> do_get_feature(std::span<std::byte> into) = 0;
  virtual Result<> do_send_feature(std::span<const std::byte> report) = 0;

  HidDeviceFacts facts_;
  std::string name_;
};

}  // namespace forager::hal
