#include "hal/linux/hidapi_device.hpp"

#include <hidapi.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <limits>
#include <utility>

#include "hal/linux/hid_sysfs.hpp"

namespace forager::hal {
namespace {

// Files held open so that the kernel's input devices give their keys to nobody else.
class Grabs {
 public:
  Grabs(Kernel& kernel, std::vector<int> files) : kernel_(&kernel), files_(std::move(files)) {}
  ~Grabs() {
    for (const int fd : files_) kernel_->close(fd);
  }
  Grabs(Grabs&& other) noexcept : kernel_(other.kernel_), files_(std::exchange(other.files_, {})) {}
  Grabs& operator=(Grabs&&) = delete;
  Grabs(const Grabs&) = delete;
  Grabs& operator=(const Grabs&) = delete;

 private:
  Kernel* kernel_;
  std::vector<int> files_;
};

struct CloseDevice {
  void operator()(hid_device* device) const { hid_close(device); }
};

class HidapiDevice final : public HidDevice {
 public:
  HidapiDevice(HidDeviceFacts facts, hid_device* device, Grabs grabs)
      : HidDevice(std::move(facts)), grabs_(std::move(grabs)), device_(device) {}

 private:
  Result<std::size_t> do_read(std::span<std::byte> into, Duration at_most) override {
    const auto ms = std::chrono::ceil<std::chrono::milliseconds>(at_most).count();
    const auto wait = static_cast<int>(std::min<std::int64_t>(ms, std::numeric_limits<int>::max()));
    const int got =
        hid_read_timeout(device_.get(), reinterpret_cast<unsigned char*>(into.data()), into.size(), wait);
    // hidraw can be read until its device is gone; nothing else fails.
    if (got < 0) return failed(ErrorCode::disconnected, "read", "the plug was pulled", "Check the cable");
    return static_cast<std::size_t>(got);
  }
  Result<> do_write(std::span<const std::byte> report) override {
    errno = 0;
    const int put =
        hid_write(device_.get(), reinterpret_cast<const unsigned char*>(report.data()), report.size());
    if (put < 0) return failure("write");
    return {};
  }
  Result<std::size_t> do_get_feature(std::span<std::byte> into) override {
    errno = 0;
    const int got =
        hid_get_feature_report(device_.get(), reinterpret_cast<unsigned char*>(into.data()), into.size());
    if (got < 0) return failure("get feature report");
    return static_cast<std::size_t>(got);
  }
  Result<> do_send_feature(std::span<const std::byte> report) override {
    errno = 0;
    const int put = hid_send_feature_report(
        device_.get(), reinterpret_cast<const unsigned char*>(report.data()), report.size());
    if (put < 0) return failure("send feature report");
    return {};
  }
  [[nodiscard]] Failure failure(std::string operation) const {
    const int error = errno;
    if (error == EPIPE)
      return failed(ErrorCode::refused, std::move(operation), "the device knows no such report", "", error);
    const ErrorCode code = code_of_device_errno(error);
    if (code == ErrorCode::disconnected)
      return failed(code, std::move(operation), "the plug was pulled", "Check the cable", error);
    return failed(code, std::move(operation), "the kernel could not pass it on", "", error);
  }

  Grabs grabs_;  // given back after the device is closed
  std::unique_ptr<hid_device, CloseDevice> device_;
};

}  // namespace

Result<std::unique_ptr<HidDevice>> make_hidapi_device(const HidDeviceFacts& facts, Kernel& kernel,
                                                      std::vector<int> grabs) {
  Grabs held(kernel, std::move(grabs));
  errno = 0;
  hid_device* device = hid_open_path(facts.path.c_str());
  if (device == nullptr) return hid_open_failure(describe(facts), errno == 0 ? EIO : errno);
  return std::make_unique<HidapiDevice>(facts, device, std::move(held));
}

}  // namespace forager::hal
