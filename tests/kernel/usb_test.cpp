// The libusb backend on the kernel's USB, with emulated devices plugged in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "hal/linux/steady_clock.hpp"
#include "hal/linux/usb_bus.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "tests/hal/usb_contract.hpp"
#include "tests/kernel/usb_plug.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::contract::eventually;
using testing::HasSubstr;

const hal::UsbMatch kEcho{.vendor = 0x1209, .product = 0x0001, .serial = {}, .path = {}};

class KernelRig final : public hal::contract::UsbRig {
 public:
  KernelRig() { plug(); }
  hal::Usb& usb() override { return *usb_; }
  void unplug() override { plug_.reset(); }
  // A device is there when the kernel has read its descriptors and udev has seen it.
  void plug() override {
    plug_.emplace(echo_);
    EXPECT_TRUE(eventually([&] { return usb_->open(kEcho).has_value(); }));
  }

 private:
  mocks::SimUsbEcho echo_;
  std::unique_ptr<hal::Usb> usb_ = hal::open_usb_bus().value();
  std::optional<UsbPlug> plug_;
};

TEST(UsbOnAKernel, NobodyMayLookButNotOpenAndTheGroupMay) {
  mocks::SimUsbEcho echo;
  const UsbPlug plug(echo);
  const auto try_it = [] {
    const auto usb = hal::open_usb_bus();
    if (!usb) return describe(usb.error());
    const auto clock = hal::make_steady_clock();
    const auto device = open_when_permitted(**usb, kEcho, *clock, 2s);
    return device ? std::string("opened")
                  : std::string(to_string(device.error().code)) + ": " + describe(device.error());
  };
  EXPECT_TRUE(eventually([&] { return as_nobody({"plugdev"}, try_it) == "opened"; }));
  const std::string refused = as_nobody({}, try_it);
  EXPECT_THAT(refused, HasSubstr("permission: usb 1209:0001"));
  EXPECT_THAT(refused, HasSubstr("99-forager.rules"));
}

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Kernel, UsbContract,
                         testing::Values(UsbRigMaker{"Libusb",
                                                     [] { return std::make_unique<kernel::KernelRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
