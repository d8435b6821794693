#include "hal/linux/i2c_dev.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>

#include "hal/success.hpp"

namespace forager::hal {
namespace {

std::string_view detail_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::no_ack:
      return "no chip answers at this address";
    case ErrorCode::timeout:
      return "the bus hangs: a chip holds SCL low";
    case ErrorCode::busy:
      return "another controller has the bus";
    case ErrorCode::disconnected:
      return "the adapter is gone";
    case ErrorCode::permission:
      return "the operating system forbids it";
    case ErrorCode::not_present:
      return "there is no such bus";
    case ErrorCode::unsupported:
      return "this adapter cannot make plain transfers";
    default:
      return "the bus failed";
  }
}

std::string_view mend_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::no_ack:
      return "Check power, address straps, and that SDA and SCL are not swapped; list with: i2cdetect -y BUS";
    case ErrorCode::permission:
      return "Join the group i2c (adduser USER i2c), and log in again";
    case ErrorCode::not_present:
      return "Enable the bus (dtparam=i2c_arm=on on a Raspberry Pi) and load i2c-dev (modprobe i2c-dev)";
    case ErrorCode::timeout:
    case ErrorCode::io:
      return "Check the pull-up resistors and the cable's length";
    default:
      return {};
  }
}

class I2cDev final : public I2c {
 public:
  I2cDev(Kernel& kernel, int fd, std::string name) : kernel_(&kernel), fd_(fd), name_(std::move(name)) {}
  ~I2cDev() override { kernel_->close(fd_); }
  I2cDev(const I2cDev&) = delete;
  I2cDev& operator=(const I2cDev&) = delete;

 private:
  Result<> do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                       std::span<std::byte> into) override;
  [[nodiscard]] std::string_view do_name() const override { return name_; }

  Kernel* kernel_;
  int fd_;
  std::string name_;
};

Failure failure(const std::string& device, std::string operation, int answer) {
  const ErrorCode code = code_of_device_errno(-answer);
  return fail(code, device, std::move(operation), std::string(detail_of(code)), std::string(mend_of(code)),
              -answer);
}

Result<> I2cDev::do_transfer(std::uint8_t address, std::span<const std::byte> bytes,
                             std::span<std::byte> into) {
  std::array<i2c_msg, 2> messages{};
  std::uint32_t count = 0;
  const auto add = [&](std::uint16_t flags, std::byte* data, std::size_t size) {
    messages[count++] = {address, flags, static_cast<std::uint16_t>(size),
                         reinterpret_cast<std::uint8_t*>(data)};
  };
  // The kernel only reads from the message of a write.
  if (!bytes.empty()) add(0, const_cast<std::byte*>(bytes.data()), bytes.size());
  if (!into.empty()) add(I2C_M_RD, into.data(), into.size());
  i2c_rdwr_ioctl_data transfer{messages.data(), count};
  const int answer = kernel_->ioctl(fd_, I2C_RDWR, &transfer);
  if (answer < 0) return failure(name_, fmt::format("transfer with 0x{:02x}", address), answer);
  if (answer != static_cast<int>(count))
    return fail(ErrorCode::io, name_, fmt::format("transfer with 0x{:02x}", address),
                fmt::format("{} of {} messages went through", answer, count));
  return success();
}

}  // namespace

Result<std::unique_ptr<I2c>> open_i2c_dev(const I2cDevConfig& config, Kernel& kernel) {
  std::string name = "i2c " + config.device;
  const int fd = kernel.open(config.device, O_RDWR);
  if (fd < 0) return failure(name, "open", fd);
  auto bus = std::make_unique<I2cDev>(kernel, fd, name);
  unsigned long functions = 0;
  if (const int answer = kernel.ioctl(fd, I2C_FUNCS, &functions); answer < 0)
    return failure(name, "ask for its functions", answer);
  if ((functions & I2C_FUNC_I2C) == 0) return failure(name, "open", -EOPNOTSUPP);
  const auto steps = std::max<std::int64_t>(
      1, (config.timeout + std::chrono::milliseconds(9)) / std::chrono::milliseconds(10));
  // The argument itself is the number: I2C_TIMEOUT takes it by value, in units of 10 ms.
  if (const int answer =
          kernel.ioctl(fd, I2C_TIMEOUT, std::bit_cast<void*>(static_cast<std::intptr_t>(steps)));
      answer < 0)
    return failure(name, "set the time-out", answer);
  return bus;
}

}  // namespace forager::hal
