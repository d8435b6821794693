#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <memory>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/file_descriptor.hpp"
#include "hal/linux/kernel.hpp"

namespace forager::hal {

Result<CallLoop> open_bare_i2c(const BareI2cConfig& config) {
  const auto failed = [name = "i2c " + config.device](const char* operation, int error) {
    return fail(code_of_device_errno(error), name, operation, "", "", error);
  };
  const auto bus = std::make_shared<FileDescriptor>(::open(config.device.c_str(), O_RDWR | O_CLOEXEC));
  if (!bus->valid()) return failed("open", errno);
  std::vector<std::uint8_t> into(config.bytes);
  const auto run = [bus, config = config, into,
                    failed](std::uint64_t calls) mutable -> Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i) {
      std::array<i2c_msg, 2> messages{
          {{config.address, 0, 1, &config.first},
           {config.address, I2C_M_RD, static_cast<std::uint16_t>(into.size()), into.data()}}};
      i2c_rdwr_ioctl_data transfer{messages.data(), messages.size()};
      if (::ioctl(bus->get(), I2C_RDWR, &transfer) != static_cast<int>(messages.size()))
        return failed("transfer", errno);
    }
    return calls;
  };
  return CallLoop(run);
}

}  // namespace forager::hal
