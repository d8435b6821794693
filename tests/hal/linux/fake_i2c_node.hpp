#pragma once

#include <linux/i2c-dev.h>
#include <linux/i2c.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/i2c.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal::fake {

// /dev/i2c-N before an emulated bus: I2C_RDWR goes there, errors become the errno an adapter gives.
class FakeI2cNode final : public Node {
 public:
  explicit FakeI2cNode(I2c& bus) : bus_(&bus) {}
  int open_errno = 0;
  unsigned long functions = I2C_FUNC_I2C;
  long timeout_steps = 0;

  int open(int) override { return -open_errno; }
  int ioctl(unsigned long request, void* argument) override {
    if (request == I2C_FUNCS) {
      *static_cast<unsigned long*>(argument) = functions;
      return 0;
    }
    if (request == I2C_TIMEOUT) {
      timeout_steps = reinterpret_cast<long>(argument);
      return 0;
    }
    return request == I2C_RDWR ? transfer(*static_cast<i2c_rdwr_ioctl_data*>(argument)) : -ENOTTY;
  }

 private:
  static int errno_of(ErrorCode code) {
    switch (code) {
      case ErrorCode::no_ack:
        return -ENXIO;
      case ErrorCode::timeout:
        return -ETIMEDOUT;
      case ErrorCode::busy:
        return -EAGAIN;
      case ErrorCode::disconnected:
        return -ENODEV;
      default:
        return -EIO;
    }
  }
  int transfer(const i2c_rdwr_ioctl_data& data) {
    std::span<std::byte> out;
    std::span<std::byte> in;
    for (std::uint32_t i = 0; i < data.nmsgs; ++i) {
      const i2c_msg& message = data.msgs[i];
      const std::span bytes(reinterpret_cast<std::byte*>(message.buf), message.len);
      ((message.flags & I2C_M_RD) != 0 ? in : out) = bytes;
    }
    const auto address = static_cast<std::uint8_t>(data.msgs[0].addr);
    const auto done = in.empty()    ? bus_->write(address, out)
                      : out.empty() ? bus_->read(address, in)
                                    : bus_->write_read(address, out, in);
    return done ? static_cast<int>(data.nmsgs) : errno_of(done.error().code);
  }

  I2c* bus_;
};

}  // namespace forager::hal::fake
