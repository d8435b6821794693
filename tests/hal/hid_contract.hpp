#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "hal/hid.hpp"
#include "tests/hal/eventually.hpp"

// The contract of hal::Hid and hal::HidDevice as tests, for every implementation alike. Include it in one
// file of a test program and instantiate HidContract with rigs.
namespace forager::hal::contract {

// A machine with one device plugged in that behaves as mocks::SimHidEcho: 1209:0002, serial number SN7.
class HidRig {
 public:
  virtual ~HidRig() = default;
  virtual Hid& hid() = 0;
  virtual void unplug() = 0;
};

struct HidRigMaker {
  std::string name;
  std::function<std::unique_ptr<HidRig>()> make;
};

class HidContract : public testing::TestWithParam<HidRigMaker> {
 protected:
  static constexpr Duration kLong = std::chrono::seconds(2);
  static constexpr Duration kShort = std::chrono::milliseconds(20);

  Hid& hid() { return rig_->hid(); }
  static HidMatch echo() {
    HidMatch match;
    match.vendor = 0x1209;
    match.product = 0x0002;
    return match;
  }
  std::unique_ptr<HidDevice> open() {
    auto device = hid().open(echo());
    EXPECT_TRUE(device.has_value()) << (device ? "" : describe(device.error()));
    return device ? *std::move(device) : nullptr;
  }
  static std::array<std::byte, 65> report(std::uint8_t seed) {
    std::array<std::byte, 65> bytes{};
    for (std::size_t i = 1; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * 7 + seed);
    return bytes;
  }

  std::unique_ptr<HidRig> rig_ = GetParam().make();
  std::array<std::byte, 64> into_{};
};

TEST_P(HidContract, TellsWhatIsPluggedIn) {
  const auto devices = hid().devices(echo());
  ASSERT_TRUE(devices.has_value());
  ASSERT_EQ(1U, devices->size());
  EXPECT_EQ("SN7", devices->front().serial);
  EXPECT_EQ(0xFF00, devices->front().usage_page);
  EXPECT_EQ("hid-generic", devices->front().driver);
  EXPECT_FALSE(devices->front().path.empty());
  EXPECT_FALSE(hid().name().empty());
  HidMatch keyboard;
  keyboard.usage_page = 1;
  keyboard.usage = 6;
  keyboard.vendor = 0x1209;
  EXPECT_TRUE(hid().devices(keyboard).value().empty());
}

TEST_P(HidContract, WhatIsNotThereCannotBeOpened) {
  HidMatch other = echo();
  other.serial = "SN8";
  const auto nobody = hid().open(other);
  ASSERT_FALSE(nobody.has_value());
  EXPECT_EQ(ErrorCode::not_present, nobody.error().code);
  EXPECT_NE(std::string::npos, describe(nobody.error()).find("SN8"));
}

TEST_P(HidContract, ReportsGoBothWaysInOrder) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  for (std::uint8_t seed = 0; seed < 5; ++seed) ASSERT_TRUE(device->write(report(seed)).has_value());
  for (std::uint8_t seed = 0; seed < 5; ++seed) {
    ASSERT_EQ(64U, device->read(into_, kLong).value());
    EXPECT_TRUE(std::equal(into_.begin(), into_.end(), report(seed).begin() + 1));
  }
}

TEST_P(HidContract, SilenceIsNothingAtOnceAndATimeoutAtTheDeadline) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  EXPECT_EQ(0U, device->poll(into_).value());
  const auto nothing = device->read(into_, kShort);
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(ErrorCode::timeout, nothing.error().code);
  EXPECT_EQ("read", nothing.error().operation);
  ASSERT_TRUE(device->write(report(1)).has_value());
  EXPECT_TRUE(eventually([&] { return device->poll(into_).value() == 64U; }));
}

TEST_P(HidContract, WhatCanNeverWorkIsNotSent) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  EXPECT_EQ(ErrorCode::invalid_argument, device->write({}).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->poll({}).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->read(into_, Duration::zero()).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->send_feature({}).error().code);
}

TEST_P(HidContract, FeatureReportsAreKept) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  std::array<std::byte, 9> feature{std::byte{0}, std::byte{0xAB}, std::byte{2}};
  ASSERT_TRUE(device->send_feature(feature).has_value());
  std::array<std::byte, 9> got{};
  ASSERT_EQ(9U, device->get_feature(got).value());
  EXPECT_EQ(feature, got);
}

TEST_P(HidContract, APulledPlugIsNotSilence) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  rig_->unplug();
  ASSERT_TRUE(eventually([&] { return !device->poll(into_).has_value(); }));
  EXPECT_EQ(ErrorCode::disconnected, device->poll(into_).error().code);
  EXPECT_EQ(ErrorCode::disconnected, device->read(into_, kShort).error().code);
  const auto gone = device->write(report(1));
  ASSERT_FALSE(gone.has_value());
  EXPECT_EQ(ErrorCode::disconnected, gone.error().code);
  EXPECT_FALSE(gone.error().device.empty());
}

}  // namespace forager::hal::contract
