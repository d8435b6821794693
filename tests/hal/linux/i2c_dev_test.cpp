#include "hal/linux/i2c_dev.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "tests/hal/linux/fake_i2c_node.hpp"
#include "tests/hal/linux/fake_kernel.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class I2cDevTest : public testing::Test {
 protected:
  I2cDevTest() {
    kernel_.files["/dev/i2c-1"] = node_;
    wires_.attach(0x40, chip_);
  }
  std::unique_ptr<I2c> open() { return open_i2c_dev({}, kernel_).value(); }
  ErrorCode code_of_opening(const std::string& device = "/dev/i2c-1") {
    const auto bus = open_i2c_dev({.device = device}, kernel_);
    return bus ? ErrorCode::invalid_state : bus.error().code;
  }
  fake::FakeKernel kernel_;
  mocks::SimI2cBus wires_{"wires"};
  mocks::SimPca9685 chip_;
  std::shared_ptr<fake::FakeI2cNode> node_ = std::make_shared<fake::FakeI2cNode>(wires_);
  std::array<std::byte, 1> byte_{};
};

TEST_F(I2cDevTest, TransfersBothWaysInOneGo) {
  const auto bus = open();
  ASSERT_TRUE(bus->write(0x40, std::array{std::byte{0x06}, std::byte{0x12}}));
  EXPECT_EQ(0x12, chip_.reg(0x06));
  ASSERT_TRUE(bus->write_read(0x40, std::array{std::byte{0xFE}}, byte_));
  EXPECT_EQ(std::byte{0x1E}, byte_[0]);
  EXPECT_EQ(2U, wires_.transfers());
  ASSERT_TRUE(bus->read(0x40, byte_));
  EXPECT_EQ(3U, wires_.transfers());
}

TEST_F(I2cDevTest, AChipThatIsNotThereIsNotABrokenBus) {
  const auto bus = open();
  const auto absent = bus->write(0x41, byte_);
  ASSERT_FALSE(absent);
  EXPECT_EQ(ErrorCode::no_ack, absent.error().code);
  EXPECT_THAT(describe(absent.error()), HasSubstr("/dev/i2c-1: transfer with 0x41: no chip answers"));
  kernel_.fail_next = EREMOTEIO;  // what i2c-bcm2835 says
  EXPECT_EQ(ErrorCode::no_ack, bus->write(0x40, byte_).error().code);
}

TEST_F(I2cDevTest, EachFailureOfTheBusHasItsOwnName) {
  const auto bus = open();
  const auto code = [&](int error) {
    kernel_.fail_next = error;
    return bus->read(0x40, byte_).error().code;
  };
  EXPECT_EQ(ErrorCode::timeout, code(ETIMEDOUT));
  EXPECT_EQ(ErrorCode::busy, code(EAGAIN));
  EXPECT_EQ(ErrorCode::disconnected, code(ENODEV));
  EXPECT_EQ(ErrorCode::disconnected, code(ESHUTDOWN));
  EXPECT_EQ(ErrorCode::io, code(EIO));
  EXPECT_EQ(ErrorCode::unsupported, code(EOPNOTSUPP));
  EXPECT_TRUE(bus->read(0x40, byte_));
}

TEST_F(I2cDevTest, WhatCanNeverWorkIsNotSent) {
  const auto bus = open();
  for (const std::uint8_t address : std::to_array<std::uint8_t>({0x00, 0x07, 0x78, 0xFF}))
    EXPECT_EQ(ErrorCode::invalid_argument, bus->read(address, byte_).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bus->write(0x40, {}).error().code);
  std::vector<std::byte> much(5000);
  EXPECT_EQ(ErrorCode::invalid_argument, bus->write(0x40, much).error().code);
  EXPECT_EQ(0U, wires_.transfers());
}

TEST_F(I2cDevTest, SaysWhyItCannotBeOpened) {
  EXPECT_EQ(ErrorCode::not_present, code_of_opening("/dev/i2c-9"));
  node_->open_errno = EACCES;
  EXPECT_EQ(ErrorCode::permission, code_of_opening());
  EXPECT_THAT(describe(open_i2c_dev({}, kernel_).error()), HasSubstr("group i2c"));
  node_->open_errno = 0;
  node_->functions = I2C_FUNC_SMBUS_BYTE_DATA;
  EXPECT_EQ(ErrorCode::unsupported, code_of_opening());
  EXPECT_EQ(0U, kernel_.open_files());
}

TEST_F(I2cDevTest, TheTimeOutIsRoundedUpToTheKernelsSteps) {
  ASSERT_TRUE(open_i2c_dev({.timeout = 11ms}, kernel_));
  EXPECT_EQ(2, node_->timeout_steps);
  ASSERT_TRUE(open_i2c_dev({.timeout = 20ms}, kernel_));
  EXPECT_EQ(2, node_->timeout_steps);
  ASSERT_TRUE(open_i2c_dev({.timeout = 0ms}, kernel_));
  EXPECT_EQ(1, node_->timeout_steps);
}

}  // namespace
}  // namespace forager::hal
