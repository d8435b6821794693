#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/usb.hpp"
#include "tests/hal/eventually.hpp"

// The contract of hal::Usb and hal::UsbDevice as tests, for every implementation alike. Include it in one
// file of a test program and instantiate UsbContract with rigs.
namespace forager::hal::contract {

// A bus with one device plugged in that behaves as mocks::SimUsbEcho: 1209:0001, serial number SN42.
class UsbRig {
 public:
  virtual ~UsbRig() = default;
  virtual Usb& usb() = 0;
  virtual void unplug() = 0;
  virtual void plug() = 0;
};

struct UsbRigMaker {
  std::string name;
  std::function<std::unique_ptr<UsbRig>()> make;
};

class UsbContract : public testing::TestWithParam<UsbRigMaker> {
 protected:
  static constexpr std::uint8_t kOut = 0x01;
  static constexpr std::uint8_t kIn = 0x81;
  static constexpr Duration kLong = std::chrono::seconds(2);
  static constexpr Duration kShort = std::chrono::milliseconds(20);
  static constexpr UsbRequest kRecall{.request = 0x42};
  static constexpr UsbRequest kRemember{.request = 0x43};
  static constexpr UsbRequest kHalt{.request = 0x44};
  static constexpr UsbRequest kUnknown{.request = 0x77};

  Usb& usb() { return rig_->usb(); }
  static UsbMatch echo() { return {.vendor = 0x1209, .product = 0x0001}; }
  std::unique_ptr<UsbDevice> open() {
    auto device = usb().open(echo());
    EXPECT_TRUE(device.has_value()) << (device ? "" : describe(device.error()));
    return device ? *std::move(device) : nullptr;
  }
  std::unique_ptr<UsbDevice> claimed() {
    auto device = open();
    if (!device) return nullptr;
    EXPECT_TRUE(device->claim(0).has_value());
    return device;
  }
  // Events of the device until one says `arrived`.
  bool told(bool arrived) {
    return eventually([&] {
      const auto events = usb().update(Instant(now_ += std::chrono::milliseconds(1)));
      EXPECT_TRUE(events.has_value());
      return events && std::any_of(events->begin(), events->end(), [&](const UsbEvent& event) {
               return event.arrived == arrived && fits(echo(), event.device);
             });
    });
  }
  static std::vector<std::byte> pattern(std::size_t count) {
    std::vector<std::byte> bytes(count);
    for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<std::byte>((i * 2654435761U) >> 13U);
    return bytes;
  }

  std::unique_ptr<UsbRig> rig_ = GetParam().make();
  Duration now_{};
  std::array<std::byte, 64> packet_{};
};

TEST_P(UsbContract, TellsWhatIsPluggedIn) {
  const auto devices = usb().devices(echo());
  ASSERT_TRUE(devices.has_value());
  ASSERT_EQ(1U, devices->size());
  const UsbDeviceFacts& device = devices->front();
  EXPECT_EQ("SN42", device.serial);
  EXPECT_FALSE(device.path.empty());
  ASSERT_EQ(1U, device.interfaces.size());
  EXPECT_EQ(0xFF, device.interfaces[0].class_code);
  ASSERT_EQ(2U, device.interfaces[0].endpoints.size());
  EXPECT_EQ(64, device.interfaces[0].endpoints[0].max_packet_bytes);
  EXPECT_FALSE(usb().name().empty());
}

TEST_P(UsbContract, WhatIsNotThereCannotBeOpened) {
  EXPECT_EQ(ErrorCode::not_present, usb().open({.vendor = 0xDEAD}).error().code);
  const auto other = usb().open({.vendor = 0x1209, .product = 0x0001, .serial = "SN43"});
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(ErrorCode::not_present, other.error().code);
  EXPECT_NE(std::string::npos, describe(other.error()).find("SN43"));
}

TEST_P(UsbContract, ControlRequestsGoBothWaysAndUnknownOnesAreRefused) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  std::array<std::byte, 8> memory{};
  ASSERT_EQ(4U, device->control_in(kRecall, memory, kLong).value());
  EXPECT_EQ(std::byte{'P'}, memory[0]);
  const std::array<std::byte, 3> word{std::byte{1}, std::byte{2}, std::byte{0xFF}};
  ASSERT_TRUE(device->control_out(kRemember, word, kLong).has_value());
  ASSERT_EQ(3U, device->control_in(kRecall, memory, kLong).value());
  EXPECT_EQ(std::byte{0xFF}, memory[2]);
  EXPECT_EQ(ErrorCode::refused, device->control_in(kUnknown, memory, kLong).error().code);
  EXPECT_EQ(ErrorCode::refused, device->control_out(kUnknown, {}, kLong).error().code);
  ASSERT_EQ(3U, device->control_in(kRecall, memory, kLong).value());  // and goes on working
}

TEST_P(UsbContract, WhatCanNeverWorkIsNotSent) {
  const auto device = open();
  ASSERT_NE(nullptr, device);
  EXPECT_EQ(ErrorCode::invalid_state, device->bulk_in(kIn, packet_, kShort).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->claim(9).error().code);
  ASSERT_TRUE(device->claim(0).has_value());
  EXPECT_EQ(ErrorCode::invalid_argument, device->bulk_in(0x02, packet_, kShort).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->bulk_in(kOut, packet_, kShort).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->bulk_out(kIn, packet_, kShort).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument,
            device->bulk_in(kIn, std::span(packet_).first(63), kShort).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->bulk_in(kIn, packet_, Duration::zero()).error().code);
  EXPECT_EQ(ErrorCode::invalid_state, device->poll_in(kIn, packet_).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, device->start(kIn, {.bytes = 100}).error().code);
}

TEST_P(UsbContract, TransfersKeepTheirBytesAndTheirBorders) {
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  for (const std::size_t count : {std::size_t{1}, std::size_t{63}, std::size_t{200}}) {
    const auto sent = pattern(count);
    ASSERT_TRUE(device->bulk_out(kOut, sent, kLong).has_value());
    std::vector<std::byte> got(256);
    ASSERT_EQ(count, device->bulk_in(kIn, got, kLong).value());
    got.resize(count);
    EXPECT_EQ(sent, got);
  }
}

TEST_P(UsbContract, SilenceEndsAtTheDeadline) {
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  const auto nothing = device->bulk_in(kIn, packet_, kShort);
  ASSERT_FALSE(nothing.has_value());
  EXPECT_EQ(ErrorCode::timeout, nothing.error().code);
  EXPECT_FALSE(nothing.error().operation.empty());
  ASSERT_TRUE(device->bulk_out(kOut, pattern(5), kLong).has_value());
  EXPECT_EQ(5U, device->bulk_in(kIn, packet_, kLong).value());
}

TEST_P(UsbContract, AHaltedEndpointRefusesUntilItIsCleared) {
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  ASSERT_TRUE(device->control_out(kHalt, {}, kLong).has_value());
  EXPECT_EQ(ErrorCode::refused, device->bulk_in(kIn, packet_, kLong).error().code);
  EXPECT_EQ(ErrorCode::refused, device->bulk_out(kOut, pattern(3), kLong).error().code);
  ASSERT_TRUE(device->clear_halt(kIn).has_value());
  ASSERT_TRUE(device->clear_halt(kOut).has_value());
  ASSERT_TRUE(device->bulk_out(kOut, pattern(3), kLong).has_value());
  EXPECT_EQ(3U, device->bulk_in(kIn, packet_, kLong).value());
}

TEST_P(UsbContract, AnInterfaceHasOneOwnerAtATime) {
  auto first = claimed();
  ASSERT_NE(nullptr, first);
  ASSERT_TRUE(first->claim(0).has_value()) << "twice is once";
  const auto second = open();
  ASSERT_NE(nullptr, second);
  EXPECT_EQ(ErrorCode::busy, second->claim(0).error().code);
  ASSERT_TRUE(first->release(0).has_value());
  EXPECT_EQ(ErrorCode::invalid_state, first->release(0).error().code);
  ASSERT_TRUE(second->claim(0).has_value());
  EXPECT_EQ(ErrorCode::busy, first->claim(0).error().code);
}

TEST_P(UsbContract, PipesCarryALotAndNeverWait) {
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  ASSERT_TRUE(device->start(kIn, {.bytes = 512, .transfers = 4}).has_value());
  ASSERT_TRUE(device->start(kOut, {.bytes = 512, .transfers = 2}).has_value());
  EXPECT_EQ(ErrorCode::invalid_state, device->start(kIn, {}).error().code);
  std::vector<std::byte> room(512);
  EXPECT_FALSE(device->poll_in(kIn, room).value().has_value());
  EXPECT_EQ(ErrorCode::invalid_argument, device->poll_in(kIn, std::span(room).first(511)).error().code);
  const auto sent = pattern(20'001);  // not whole packets: the last one is short and ends its transfer
  std::vector<std::byte> got;
  std::size_t pushed = 0;
  ASSERT_TRUE(eventually([&] {
    if (pushed < sent.size()) pushed += device->push_out(kOut, std::span(sent).subspan(pushed)).value();
    while (const auto count = device->poll_in(kIn, room).value())
      got.insert(got.end(), room.begin(), room.begin() + static_cast<std::ptrdiff_t>(*count));
    return got.size() >= sent.size();
  }));
  EXPECT_EQ(sent, got);
  EXPECT_TRUE(device->drain(kOut, kLong).has_value());
  device->stop(kIn);
  EXPECT_EQ(ErrorCode::invalid_state, device->poll_in(kIn, room).error().code);
  device->stop(kIn);
}

TEST_P(UsbContract, APulledPlugEndsEverythingWithItsOwnError) {
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  ASSERT_TRUE(device->start(kIn, {.bytes = 512, .transfers = 4}).has_value());
  std::vector<std::byte> room(512);
  ASSERT_FALSE(device->poll_in(kIn, room).value().has_value());
  rig_->unplug();
  ASSERT_TRUE(eventually([&] { return !device->poll_in(kIn, room).has_value(); }));
  const auto gone = device->poll_in(kIn, room);
  ASSERT_FALSE(gone.has_value());
  EXPECT_EQ(ErrorCode::disconnected, gone.error().code);
  EXPECT_EQ(ErrorCode::disconnected, device->bulk_out(kOut, pattern(3), kLong).error().code);
  EXPECT_EQ(ErrorCode::disconnected, device->control_in(kRecall, packet_, kLong).error().code);
  EXPECT_FALSE(gone.error().device.empty());
}

TEST_P(UsbContract, PlugsAreToldBothWaysAndAReplacedDeviceWorks) {
  ASSERT_TRUE(told(true));
  rig_->unplug();
  ASSERT_TRUE(told(false));
  EXPECT_EQ(ErrorCode::not_present, usb().open(echo()).error().code);
  rig_->plug();
  ASSERT_TRUE(told(true));
  EXPECT_TRUE(usb().update(Instant(now_)).value().empty());
  const auto device = claimed();
  ASSERT_NE(nullptr, device);
  ASSERT_TRUE(device->bulk_out(kOut, pattern(3), kLong).has_value());
  EXPECT_EQ(3U, device->bulk_in(kIn, packet_, kLong).value());
}

}  // namespace forager::hal::contract
