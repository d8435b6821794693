#pragma once

#include "mocks/fake_hid.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal::fake {

// What stands behind the functions of hidapi in this test program, which defines them itself: a FakeHid, and
// a kernel for sysfs and /dev. One for the program; each test begins with a new one.
struct Hidapi {
  mocks::FakeHid hid;
  FakeKernel kernel;
  int open_devices = 0;
  int initialised = 0;

  // A HID device as the kernel shows it: /sys/bus/hid/devices/0003:VVVV:PPPP.000N, its hidraw (if its path
  // says so) and, with an event file, the input device made of it.
  void show(const HidDeviceFacts& facts, int count, const std::string& event = {});
};

// A file of /dev: opens, or refuses with an errno; keeps the last EVIOCGRAB.
class DeviceFile final : public Node {
 public:
  int refuse_open = 0;
  int refuse_grab = 0;
  bool grabbed = false;
  int open(int) override { return -refuse_open; }
  int ioctl(unsigned long request, void* argument) override;
  void close() override { grabbed = false; }
};

[[nodiscard]] Hidapi& hidapi();
void new_hidapi();

}  // namespace forager::hal::fake
