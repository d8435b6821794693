#pragma once

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hal/modbus.hpp"

// The contract of hal::Modbus as tests, for every implementation alike. Include it in one file of a test
// program and instantiate ModbusContract with rigs.
namespace forager::hal::contract {

// A bus with unit 7 on it: holding registers 10 to 19, input registers 20 to 21 that read 0x1234 and 0xFFFE,
// coil 3.
class ModbusRig {
 public:
  virtual ~ModbusRig() = default;
  virtual Modbus& bus() = 0;
  virtual std::uint16_t holding(std::uint16_t address) = 0;  // what the device keeps
  virtual bool coil(std::uint16_t address) = 0;
  virtual void unplug() = 0;
};

struct ModbusRigMaker {
  std::string name;
  std::function<std::unique_ptr<ModbusRig>()> make;
};

class ModbusContract : public testing::TestWithParam<ModbusRigMaker> {
 protected:
  Modbus& bus() { return rig_->bus(); }
  std::unique_ptr<ModbusRig> rig_ = GetParam().make();
  std::array<std::uint16_t, 2> two_{};
};

TEST_P(ModbusContract, ReadsAndWritesRegistersAndCoils) {
  ASSERT_TRUE(bus().write_holding(7, 10, std::array<std::uint16_t, 1>{0xBEEF}).has_value());
  EXPECT_EQ(0xBEEF, rig_->holding(10));
  ASSERT_TRUE(bus().write_holding(7, 11, std::array<std::uint16_t, 3>{1, 0, 0xFFFF}).has_value());
  EXPECT_EQ(1, rig_->holding(11));
  EXPECT_EQ(0xFFFF, rig_->holding(13));
  ASSERT_TRUE(bus().read_holding(7, 10, two_).has_value());
  EXPECT_EQ((std::array<std::uint16_t, 2>{0xBEEF, 1}), two_);
  ASSERT_TRUE(bus().read_input(7, 20, two_).has_value());
  EXPECT_EQ((std::array<std::uint16_t, 2>{0x1234, 0xFFFE}), two_);
  for (const bool on : {true, false}) {
    ASSERT_TRUE(bus().write_coil(7, 3, on).has_value());
    EXPECT_EQ(on, rig_->coil(3));
  }
}

TEST_P(ModbusContract, WhatTheDeviceDoesNotHaveItRefuses) {
  const auto beyond = bus().read_holding(7, 19, two_);
  ASSERT_FALSE(beyond.has_value());
  EXPECT_EQ(ErrorCode::refused, beyond.error().code);
  EXPECT_NE(std::string::npos, beyond.error().detail.find("exception 2"));
  EXPECT_EQ(ErrorCode::refused, bus().write_coil(7, 4, true).error().code);
  EXPECT_EQ(ErrorCode::refused, bus().read_input(7, 10, two_).error().code);
  EXPECT_EQ(ErrorCode::refused, bus().write_holding(7, 20, two_).error().code);
  ASSERT_TRUE(bus().read_holding(7, 10, two_).has_value());  // and goes on working
}

TEST_P(ModbusContract, AnotherUnitIsSilence) {
  const auto nobody = bus().read_holding(8, 10, two_);
  ASSERT_FALSE(nobody.has_value());
  EXPECT_EQ(ErrorCode::timeout, nobody.error().code);
  EXPECT_FALSE(nobody.error().device.empty());
  EXPECT_FALSE(nobody.error().operation.empty());
  ASSERT_TRUE(bus().read_holding(7, 10, two_).has_value());
}

TEST_P(ModbusContract, WhatCanNeverWorkIsNotSent) {
  std::vector<std::uint16_t> much(126);
  EXPECT_EQ(ErrorCode::invalid_argument, bus().read_holding(248, 10, two_).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bus().read_holding(7, 0, much).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bus().read_input(7, 0, {}).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bus().read_input(7, 65535, two_).error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, bus().write_holding(7, 0, std::span(much).first(124)).error().code);
}

TEST_P(ModbusContract, ALineThatIsGoneIsNotSilence) {
  ASSERT_TRUE(bus().read_holding(7, 10, two_).has_value());
  rig_->unplug();
  const auto gone = bus().read_holding(7, 10, two_);
  ASSERT_FALSE(gone.has_value());
  EXPECT_EQ(ErrorCode::disconnected, gone.error().code);
}

}  // namespace forager::hal::contract
