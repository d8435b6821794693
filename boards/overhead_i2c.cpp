#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include "boards/bench_board.hpp"
#include "boards/overhead_contest.hpp"
#include "hal/linux/bare_calls.hpp"
#include "hal/linux/i2c_dev.hpp"

namespace forager::boards {
namespace {

constexpr std::size_t kBytes = 2;  // read at a time

// A system call that does nothing.
long enter_kernel() { return ::syscall(SYS_getppid); }

class IdleKernel final : public hal::Kernel {
 public:
  int open(const std::string&, int) override { return 3; }
  int close(int) override { return 0; }
  long read(int, std::span<char>) override { return -EBADF; }
  long write(int, std::string_view) override { return -EBADF; }
  int ioctl(int, unsigned long request, void* argument) override {
    if (request == I2C_FUNCS) *static_cast<unsigned long*>(argument) = I2C_FUNC_I2C;
    if (request != I2C_RDWR) return 0;
    if (enter_kernel() < 0) return -EIO;
    return static_cast<int>(static_cast<i2c_rdwr_ioctl_data*>(argument)->nmsgs);
  }
  int lock(int) override { return 0; }
  std::vector<std::string> list(const std::string&) override { return {}; }
  std::string link(const std::string&) override { return {}; }
};

hal::Result<OverheadContest::Side> open_ours(const std::string& bus, std::uint8_t address,
                                             const std::shared_ptr<hal::Kernel>& kernel) {
  auto opened = hal::open_i2c_dev({.device = bus, .timeout = std::chrono::seconds(1)},
                                  kernel ? *kernel : hal::real_kernel());
  if (!opened) return hal::fail(std::move(opened).error());
  const auto run = [kernel, open = std::shared_ptr<hal::I2c>(*std::move(opened)),
                    address](std::uint64_t calls) -> hal::Result<std::uint64_t> {
    const std::array first{std::byte{0}};
    std::array<std::byte, kBytes> into{};
    for (std::uint64_t i = 0; i < calls; ++i) FORAGER_TRY(open->write_read(address, first, into));
    return calls;
  };
  return OverheadContest::Side(run);
}

}  // namespace

hal::Result<OverheadContest> overhead_i2c(const std::string& chip) {
  const auto place = find_chip({}, chip);
  if (!place) return hal::fail(place.error());
  return OverheadContest{
      .name = "I2C transfer",
      .ours = "I2c::write_read",
      .bare = "I2C_RDWR of i2c-dev",
      .unit = "call",
      .batch = std::chrono::milliseconds(5),
      .open_ours = [place = *place] { return open_ours(place.bus, place.address, nullptr); },
      .open_bare =
          [place = *place] {
            return hal::open_bare_i2c({.device = place.bus, .address = place.address, .bytes = kBytes});
          }};
}

OverheadContest overhead_i2c_floor() {
  const auto bare = [](std::uint64_t calls) -> hal::Result<std::uint64_t> {
    for (std::uint64_t i = 0; i < calls; ++i)
      if (enter_kernel() < 0) return hal::fail(hal::ErrorCode::io, "kernel", "getppid", "");
    return calls;
  };
  return {.name = "I2C transfer over nothing",
          .ours = "I2c::write_read",
          .bare = "an empty system call",
          .unit = "call",
          .batch = std::chrono::milliseconds(1),
          .open_ours = [] { return open_ours("/dev/i2c-0", 0x40, std::make_shared<IdleKernel>()); },
          .open_bare = [bare]() -> hal::Result<OverheadContest::Side> { return bare; }};
}

}  // namespace forager::boards
