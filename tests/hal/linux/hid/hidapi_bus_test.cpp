#include <gmock/gmock.h>

#include <cerrno>

#include "hal/linux/hid_bus.hpp"
#include "hal/linux/hid_sysfs.hpp"
#include "mocks/sim_hid_echo.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_mcp2221.hpp"
#include "mocks/sim_wedge.hpp"
#include "tests/hal/hid_contract.hpp"
#include "tests/hal/linux/hid/fake_hidapi.hpp"

namespace forager::hal::contract {
namespace {

using fake::DeviceFile;
using fake::hidapi;
using testing::HasSubstr;

class HidapiRig final : public HidRig {
 public:
  HidapiRig() {
    fake::new_hidapi();
    hidapi().hid.plug(echo_);
    hidapi().show(echo_.facts(), 1);
    hid_ = open_hid_bus(hidapi().kernel).value();
  }
  Hid& hid() override { return *hid_; }
  void unplug() override { hidapi().hid.unplug(echo_); }

 private:
  mocks::SimHidEcho echo_;
  std::unique_ptr<Hid> hid_;
};

INSTANTIATE_TEST_SUITE_P(Hidapi, HidContract,
                         testing::Values(HidRigMaker{"Hidapi", [] { return std::make_unique<HidapiRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });

class HidapiTest : public testing::Test {
 protected:
  HidapiTest() {
    fake::new_hidapi();
    hidapi().hid.plug(keyboard_);
    hidapi().show(keyboard_.facts(), 5, "event3");
    hid_ = open_hid_bus(hidapi().kernel).value();
  }
  static HidMatch keyboard() {
    HidMatch match;
    match.usage_page = 1;
    match.usage = 6;
    return match;
  }
  static DeviceFile& file(const std::string& path) {
    return dynamic_cast<DeviceFile&>(*hidapi().kernel.files.at(path));
  }

  mocks::SimWedge keyboard_;
  std::unique_ptr<Hid> hid_;
};

TEST_F(HidapiTest, NamesItselfAndGivesEverythingBack) {
  EXPECT_EQ("hid by hidapi 0.13.1", hid_->name());
  { const auto device = hid_->open(keyboard(), HidSharing::exclusive).value(); }
  EXPECT_EQ(0, hidapi().open_devices);
  EXPECT_EQ(0U, hidapi().kernel.open_files());
  hid_.reset();
  EXPECT_EQ(0, hidapi().initialised);
}

TEST_F(HidapiTest, ExclusiveTakesTheKeysFromTheConsoleForAsLongAsItLasts) {
  auto device = hid_->open(keyboard(), HidSharing::exclusive).value();
  EXPECT_TRUE(file("/dev/input/event3").grabbed);
  keyboard_.type("a");
  std::array<std::byte, 8> report{};
  EXPECT_EQ(8U, device->poll(report).value());
  device.reset();
  EXPECT_FALSE(file("/dev/input/event3").grabbed);
  const auto shared = hid_->open(keyboard()).value();
  EXPECT_FALSE(file("/dev/input/event3").grabbed);
}

TEST_F(HidapiTest, WhatStandsInTheWayOfExclusivenessIsNamed) {
  struct Case {
    int open_errno;
    int grab_errno;
    ErrorCode code;
    std::string says;
  };
  for (const Case& each : {Case{EACCES, 0, ErrorCode::permission, "group input"},
                           Case{0, EBUSY, ErrorCode::busy, "another program"},
                           Case{0, ENODEV, ErrorCode::disconnected, "event3"}}) {
    file("/dev/input/event3").refuse_open = each.open_errno;
    file("/dev/input/event3").refuse_grab = each.grab_errno;
    const auto opened = hid_->open(keyboard(), HidSharing::exclusive);
    ASSERT_FALSE(opened.has_value());
    EXPECT_EQ(each.code, opened.error().code);
    EXPECT_THAT(describe(opened.error()), HasSubstr(each.says));
    EXPECT_EQ(0U, hidapi().kernel.open_files());
  }
}

TEST_F(HidapiTest, AKernelWithoutEventDevicesCannotMakeItExclusive) {
  auto& files = hidapi().kernel.files;
  for (auto each = files.begin(); each != files.end();)
    each = each->first.find("event3") != std::string::npos ? files.erase(each) : std::next(each);
  const auto opened = hid_->open(keyboard(), HidSharing::exclusive);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::unsupported, opened.error().code);
  EXPECT_THAT(describe(opened.error()), HasSubstr("evdev"));
}

TEST_F(HidapiTest, WhyItCannotBeOpenedComesFromTheKernel) {
  file("/dev/hidraw1").refuse_open = EACCES;
  const auto forbidden = hid_->open(keyboard());
  ASSERT_FALSE(forbidden.has_value());
  EXPECT_EQ(ErrorCode::permission, forbidden.error().code);
  EXPECT_THAT(describe(forbidden.error()), HasSubstr("99-forager.rules"));
  file("/dev/hidraw1").refuse_open = ENODEV;
  EXPECT_EQ(ErrorCode::disconnected, hid_->open(keyboard()).error().code);
  hidapi().kernel.files.erase("/dev/hidraw1");
  EXPECT_EQ(ErrorCode::disconnected, hid_->open(keyboard()).error().code);
}

TEST_F(HidapiTest, ADeviceTheKernelKeepsForItselfIsListedAndExplained) {
  mocks::SimI2cBus wires("wires");
  mocks::SimMcp2221 chip(wires);
  EXPECT_FALSE(mcp2221_held_by_kernel(hidapi().kernel).has_value());
  HidDeviceFacts held = chip.facts();
  held.path.clear();
  held.driver = "mcp2221";
  hidapi().show(held, 6);
  HidMatch bridge;
  bridge.vendor = 0x04D8;
  bridge.product = 0x00DD;
  const auto listed = hid_->devices(bridge).value();
  ASSERT_EQ(1U, listed.size());
  EXPECT_EQ("SN0001", listed[0].serial);
  EXPECT_EQ("mcp2221", listed[0].driver);
  const auto opened = hid_->open(bridge);
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::busy, opened.error().code);
  const auto why = mcp2221_held_by_kernel(hidapi().kernel);
  ASSERT_TRUE(why.has_value());
  EXPECT_THAT(describe(*why), HasSubstr("blacklist hid_mcp2221"));
}

TEST_F(HidapiTest, NamesThatAreNoDevicesAreLeftOut) {
  hidapi().kernel.files["/sys/bus/hid/devices/nonsense/uevent"] = std::make_shared<DeviceFile>();
  hidapi().kernel.files["/sys/bus/hid/devices/0003:XYZW:00DD.0009/uevent"] = std::make_shared<DeviceFile>();
  EXPECT_EQ(1U, list_hid_nodes(hidapi().kernel).size());
}

}  // namespace
}  // namespace forager::hal::contract
