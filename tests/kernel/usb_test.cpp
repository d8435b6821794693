// The libusb backend on the kernel's USB, with emulated devices plugged in.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "hal/linux/serial_port.hpp"
#include "hal/linux/steady_clock.hpp"
#include "hal/linux/usb_bus.hpp"
#include "mocks/memory_stream.hpp"
#include "mocks/sim_ftdi.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/hal/usb_contract.hpp"
#include "tests/kernel/usb_plug.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::contract::bytes_of;
using hal::contract::eventually;
using hal::contract::text_of;
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

// An FTDI adapter: what the kernel's own driver makes of the emulator, and how it is taken from it.
class FtdiOnAKernel : public testing::Test {
 protected:
  static constexpr const char* kPort = "/dev/ttyUSB0";
  FtdiOnAKernel() {
    EXPECT_TRUE(eventually([] { return std::filesystem::exists(kPort); }));
  }
  std::unique_ptr<hal::Clock> clock_ = hal::make_steady_clock();
  mocks::MemoryStreamPair line_{"line", mocks::MemoryStreamKind::bytes};
  mocks::SimFtdi adapter_{line_.near()};
  UsbPlug plug_{adapter_};
};

TEST_F(FtdiOnAKernel, TheKernelsDriverTakesTheEmulatorForARealAdapter) {
  const auto port =
      hal::open_serial_port({.device = kPort, .line = {.baud = 57600, .parity = hal::Parity::even}}, *clock_);
  ASSERT_TRUE(port->open());
  ASSERT_TRUE(eventually([&] {
    const auto state = port->poll();
    EXPECT_TRUE(state) << describe(state.error());
    return !state || *state == hal::StreamState::open;
  }));
  ASSERT_EQ(4U, port->write(bytes_of("ping")).value());
  std::vector<std::byte> room(16);
  std::string heard;
  EXPECT_TRUE(eventually([&] {
    const auto held = plug_.lock();
    heard += text_of(std::span(room).first(line_.far().read(room).value_or(0)));
    return heard == "ping";
  })) << heard;
  {
    const auto held = plug_.lock();
    EXPECT_NEAR(57600.0, adapter_.baud(), 300.0);
    EXPECT_EQ(hal::Parity::even, adapter_.line().parity);
    EXPECT_TRUE(adapter_.dtr());
    ASSERT_EQ(4U, line_.far().write(bytes_of("pong")).value());
  }
  EXPECT_EQ("pong", hal::contract::read_text(*port, 4));
}

TEST_F(FtdiOnAKernel, NobodyMayNotAndTheGroupMay) {
  const auto try_it = [] {
    const auto usb = hal::open_usb_bus();
    if (!usb) return describe(usb.error());
    const auto device = (*usb)->open({.vendor = 0x0403, .product = {}, .serial = {}, .path = {}});
    return device ? std::string("opened") : describe(device.error());
  };
  EXPECT_TRUE(eventually([&] { return as_nobody({"plugdev"}, try_it) == "opened"; }));
  EXPECT_THAT(as_nobody({}, try_it),
              testing::AllOf(HasSubstr("usb 0403:6001"), HasSubstr("99-forager.rules")));
}

TEST_F(FtdiOnAKernel, AClaimTakesThePortFromTheKernelAndReleasingGivesItBack) {
  auto usb = hal::open_usb_bus().value();
  ASSERT_TRUE(eventually([&] {
    const auto found = usb->devices({.vendor = 0x0403, .product = {}, .serial = {}, .path = {}});
    return found && found->size() == 1 && found->front().interfaces[0].driver == "ftdi_sio";
  }));
  {
    auto device = usb->open({.vendor = 0x0403, .product = {}, .serial = {}, .path = {}});
    ASSERT_TRUE(device) << describe(device.error());
    ASSERT_TRUE((*device)->claim(0));
    EXPECT_TRUE(eventually([] { return !std::filesystem::exists(kPort); }));
  }
  EXPECT_TRUE(eventually([] { return std::filesystem::exists(kPort); }));
}

}  // namespace
}  // namespace forager::kernel

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Kernel, UsbContract,
                         testing::Values(UsbRigMaker{"Libusb",
                                                     [] { return std::make_unique<kernel::KernelRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
