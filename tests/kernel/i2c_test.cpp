// The i2c-dev backend on an adapter of the kernel whose wires lead to emulated chips (modules/i2c_sim.c).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "hal/linux/i2c_dev.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "tests/kernel/i2c_bridge.hpp"
#include "tests/kernel/user.hpp"

namespace forager::kernel {
namespace {

using namespace std::chrono_literals;
using hal::ErrorCode;
using testing::HasSubstr;

constexpr const char* kAdapter = "/dev/i2c-7";

class I2cOnAKernel : public testing::Test {
 protected:
  I2cOnAKernel() { wires_.attach(0x41, chip_); }
  static std::unique_ptr<hal::I2c> open(hal::Duration timeout = 2s) {
    return hal::open_i2c_dev({.device = kAdapter, .timeout = timeout}).value();
  }
  mocks::SimI2cBus wires_{"wires"};
  mocks::SimPca9685 chip_;
  I2cBridge bridge_{wires_};
  std::array<std::byte, 2> two_{};
};

TEST_F(I2cOnAKernel, TransfersArriveAsTheyWereSent) {
  const auto bus = open();
  ASSERT_TRUE(bus->write(0x41, std::array{std::byte{0x00}, std::byte{0x31}}));  // auto-increment, asleep
  ASSERT_TRUE(bus->write(0x41, std::array{std::byte{0x06}, std::byte{0x12}, std::byte{0x03}}));
  EXPECT_EQ(0x12, chip_.reg(0x06));
  EXPECT_EQ(0x03, chip_.reg(0x07));
  ASSERT_TRUE(bus->write_read(0x41, std::array{std::byte{0x06}}, two_));
  EXPECT_EQ((std::array{std::byte{0x12}, std::byte{0x03}}), two_);
  ASSERT_TRUE(bus->read(0x41, two_));
  EXPECT_EQ(4U, wires_.transfers());
}

TEST_F(I2cOnAKernel, EachFailureOfTheBusHasItsOwnName) {
  const auto bus = open();
  const auto absent = bus->read(0x29, two_);
  ASSERT_FALSE(absent);
  EXPECT_EQ(ErrorCode::no_ack, absent.error().code);
  EXPECT_THAT(describe(absent.error()), HasSubstr("i2c /dev/i2c-7: transfer with 0x29: no chip answers"));
  wires_.disconnect(true);
  EXPECT_EQ(ErrorCode::disconnected, bus->read(0x41, two_).error().code);
  wires_.disconnect(false);
  bridge_.hang(true);
  EXPECT_EQ(ErrorCode::timeout, open(30ms)->read(0x41, two_).error().code);
  bridge_.hang(false);
  static_cast<void>(open());  // the time-out belongs to the adapter, and so to everybody
  EXPECT_TRUE(bus->read(0x41, two_));
  std::vector<std::byte> much(1025);
  EXPECT_EQ(ErrorCode::unsupported, bus->read(0x41, much).error().code) << "more than this adapter takes";
}

TEST_F(I2cOnAKernel, WhatCannotBeOpenedSaysWhy) {
  const auto code = [](const char* device) {
    const auto bus = hal::open_i2c_dev({.device = device});
    return bus ? ErrorCode::invalid_state : bus.error().code;
  };
  EXPECT_EQ(ErrorCode::not_present, code("/dev/i2c-99"));
  EXPECT_EQ(ErrorCode::unsupported, code("/dev/i2c-0")) << "i2c-stub knows SMBus commands only";
}

TEST_F(I2cOnAKernel, NobodyMayNotAndTheGroupMay) {
  const auto try_it = [] {
    const auto bus = hal::open_i2c_dev({.device = kAdapter});
    return bus ? "opened" : std::string(to_string(bus.error().code)) + ": " + describe(bus.error());
  };
  EXPECT_THAT(as_nobody({}, try_it), testing::AllOf(HasSubstr("permission: "), HasSubstr("group i2c")));
  EXPECT_EQ("opened", as_nobody({"i2c"}, try_it));
}

}  // namespace
}  // namespace forager::kernel
