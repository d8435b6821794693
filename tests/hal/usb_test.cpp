#include "hal/usb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/fake_usb.hpp"
#include "mocks/sim_usb_echo.hpp"
#include "mocks/virtual_clock.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const UsbMatch kEcho{.vendor = 0x1209, .product = 0x0001};

TEST(Usb, TwoThatFitAreNamedAndOneIsChosenBySerialNumberOrPath) {
  mocks::SimUsbEcho left("1-1", "LEFT");
  mocks::SimUsbEcho right("1-2.4", "RIGHT");
  mocks::FakeUsb usb;
  usb.plug(right);
  usb.plug(left);
  const auto either = usb.open(kEcho);
  ASSERT_FALSE(either.has_value());
  EXPECT_EQ(ErrorCode::invalid_argument, either.error().code);
  EXPECT_THAT(describe(either.error()), HasSubstr("at 1-1, 1-2.4"));
  EXPECT_EQ("1-2.4", usb.open({.serial = "RIGHT"}).value()->facts().path);
  EXPECT_EQ("usb 1209:0001 at 1-1", usb.open({.path = "1-1"}).value()->name());
}

TEST(Usb, DescribesWhatIsMeant) {
  EXPECT_EQ("usb any device", describe(UsbMatch{}));
  EXPECT_EQ("usb 0403:* serial A5 at 1-2",
            describe(UsbMatch{.vendor = 0x0403, .serial = "A5", .path = "1-2"}));
}

// udev comes to a device some time after the kernel has announced it.
class LateUdev final : public Clock {
 public:
  LateUdev(mocks::FakeUsb& usb, mocks::SimUsbEcho& echo, Instant at) : usb_(usb), echo_(echo), at_(at) {}

 private:
  Instant do_now() const override { return now_; }
  void do_sleep_until(Instant when) override {
    now_ = when;
    if (now_ >= at_) usb_.permit(echo_);
  }
  mocks::FakeUsb& usb_;
  mocks::SimUsbEcho& echo_;
  Instant at_;
  Instant now_;
};

TEST(Usb, AMissingPermissionIsWaitedForAndNotForEver) {
  mocks::SimUsbEcho echo;
  mocks::FakeUsb usb;
  usb.plug(echo, false);
  mocks::VirtualClock nobody_comes;
  EXPECT_EQ(ErrorCode::permission, open_when_permitted(usb, kEcho, nobody_comes, 500ms).error().code);
  EXPECT_LE(nobody_comes.now(), Instant(600ms));
  LateUdev clock(usb, echo, Instant(100ms));
  EXPECT_TRUE(open_when_permitted(usb, kEcho, clock, 500ms).has_value());
  EXPECT_LE(clock.now(), Instant(200ms));
  usb.unplug(echo);
  mocks::VirtualClock other;
  EXPECT_EQ(ErrorCode::not_present, open_when_permitted(usb, kEcho, other, 500ms).error().code);
  EXPECT_EQ(Instant{}, other.now()) << "what waiting cannot mend is not waited for";
}

TEST(FakeUsb, AClaimTakesTheInterfaceFromItsDriverAndTheEndGivesItBack) {
  mocks::SimUsbEcho echo;
  echo.set_driver("cdc_acm");
  mocks::FakeUsb usb;
  usb.plug(echo);
  auto device = usb.open(kEcho).value();
  ASSERT_TRUE(device->claim(0).has_value());
  EXPECT_EQ("usbfs", usb.devices().value()[0].interfaces[0].driver);
  device.reset();
  EXPECT_EQ("cdc_acm", usb.devices().value()[0].interfaces[0].driver);
}

TEST(FakeUsb, WhatArrivedBeforeThePlugWasPulledIsHandedOut) {
  mocks::SimUsbEcho echo;
  mocks::FakeUsb usb;
  usb.plug(echo);
  const auto device = usb.open(kEcho).value();
  ASSERT_TRUE(device->claim(0).has_value());
  ASSERT_TRUE(device->start(0x81, {.bytes = 64, .transfers = 2}).has_value());
  const std::array<std::byte, 3> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  ASSERT_TRUE(device->bulk_out(0x01, bytes, 10ms).has_value());
  usb.unplug(echo);
  std::array<std::byte, 64> room{};
  EXPECT_EQ(3U, device->poll_in(0x81, room).value());
  EXPECT_EQ(ErrorCode::disconnected, device->poll_in(0x81, room).error().code);
}

}  // namespace
}  // namespace forager::hal
