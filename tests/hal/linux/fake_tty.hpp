#pragma once

#include <asm/ioctls.h>
#include <asm/termbits.h>

#include <functional>
#include <string>

#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal::fake {

// A serial port as drivers/tty keeps it: takes of a wish what the adapter can do and says nothing of the
// rest.
class FakeTty final : public Node {
 public:
  int open_errno = 0;
  bool locked_by_another = false;
  bool unplugged = false;
  std::function<std::uint32_t(std::uint32_t)> divider = [](std::uint32_t baud) { return baud; };
  tcflag_t cannot = 0;  // bits of c_cflag the adapter has no hardware for
  std::string incoming;
  bool full = false;
  termios2 state{};
  bool exclusive = false;
  int thrown_away = -1;  // TCIFLUSH, TCOFLUSH or both, the last time

  int open(int flags) override {
    open_flags = flags;
    return exclusive ? -EBUSY : -open_errno;
  }
  void close() override { exclusive = false; }  // the flag goes with the last who has it open
  int lock() override { return locked_by_another ? -EAGAIN : 0; }
  long read(std::string& into) override {
    if (unplugged) return 0;  // a port that hung up is at its end
    if (incoming.empty()) return -EAGAIN;
    into = std::exchange(incoming, {});
    return static_cast<long>(into.size());
  }
  long write(std::string_view) override { return unplugged ? -EIO : full ? -EAGAIN : 0; }
  int ioctl(unsigned long request, void* argument) override {
    if (unplugged) return -EIO;
    switch (request) {
      case TCGETS2:
        *static_cast<termios2*>(argument) = state;
        return 0;
      case TCSETS2:
        state = *static_cast<termios2*>(argument);
        state.c_ospeed = divider(state.c_ospeed);
        state.c_cflag &= ~cannot;
        return 0;
      case TIOCEXCL:
      case TIOCNXCL:
        exclusive = request == TIOCEXCL;
        return 0;
      case TCFLSH:
        thrown_away = static_cast<int>(reinterpret_cast<long>(argument));
        return 0;
      default:
        return -ENOTTY;
    }
  }

  int open_flags = 0;
};

}  // namespace forager::hal::fake
