#pragma once

#include <map>
#include <optional>
#include <string>

#include "mocks/fake_usb.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal::fake {

// What stands behind the functions of libusb in this test program, which defines them itself: a FakeUsb, the
// drivers a kernel would have bound, and failures to order. One for the program; each test begins with a new
// one.
struct Libusb {
  mocks::FakeUsb usb;
  FakeKernel kernel;                           // for sysfs
  std::map<std::string, std::string> drivers;  // "1-1:0" -> "cdc_acm"; what libusb detaches and attaches
  bool hotplug = true;
  std::optional<int> fail_init;
  std::optional<int> fail_transfer;  // LIBUSB_TRANSFER_ status of the next asynchronous transfer to end
  std::optional<int> fail_sync;      // LIBUSB_ERROR_ of the next blocking transfer or request
  std::optional<int> fail_claim;
  int open_handles = 0;
  int transfers = 0;  // allocated and not freed
  int contexts = 0;

  // What sysfs says of a device that is plugged in.
  void describe_in_sysfs(const UsbDeviceFacts& facts);
};

[[nodiscard]] Libusb& libusb();
// Forgets everything.
void new_libusb();

}  // namespace forager::hal::fake
