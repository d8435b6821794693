#include "servo/modbus_register.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "mocks/fake_modbus.hpp"

namespace forager::servo {
namespace {

using testing::HasSubstr;

ModbusRegister quantity(RegisterType type, WordOrder order = WordOrder::high_first, double scale = 1.0) {
  return {.name = "speed", .address = 10, .type = type, .order = order, .scale = scale, .unit = "m"};
}

double decoded(const ModbusRegister& q, std::uint16_t first, std::uint16_t second = 0) {
  return decode(q, {{first, second}, words_of(q.type)}).value();
}

TEST(ModbusRegister, EveryTypeMeansWhatItsManualSays) {
  EXPECT_DOUBLE_EQ(65534.0, decoded(quantity(RegisterType::u16), 0xFFFE));
  EXPECT_DOUBLE_EQ(-2.0, decoded(quantity(RegisterType::i16), 0xFFFE));
  EXPECT_DOUBLE_EQ(0x00012345, decoded(quantity(RegisterType::u32), 0x0001, 0x2345));
  EXPECT_DOUBLE_EQ(0x00012345, decoded(quantity(RegisterType::u32, WordOrder::low_first), 0x2345, 0x0001));
  EXPECT_DOUBLE_EQ(-3.0, decoded(quantity(RegisterType::i32), 0xFFFF, 0xFFFD));
  EXPECT_DOUBLE_EQ(-12.5, decoded(quantity(RegisterType::f32), 0xC148, 0x0000));  // IEEE 754: c1480000
  EXPECT_DOUBLE_EQ(-12.5, decoded(quantity(RegisterType::f32, WordOrder::low_first), 0x0000, 0xC148));
  EXPECT_DOUBLE_EQ(25.2, decoded(quantity(RegisterType::u16, WordOrder::high_first, 0.01), 2520));
  ModbusRegister kelvin = quantity(RegisterType::u16, WordOrder::high_first, 0.1);
  kelvin.offset = -273.1;
  EXPECT_NEAR(20.0, decoded(kelvin, 2931), 1e-9);
}

TEST(ModbusRegister, WhatIsNoNumberOrDoesNotFitIsSaid) {
  const auto nan = decode(quantity(RegisterType::f32), {{0x7FC0, 0}, 2});
  EXPECT_EQ(hal::ErrorCode::protocol, nan.error().code);
  const auto q = quantity(RegisterType::i16, WordOrder::high_first, 0.1);
  EXPECT_EQ(hal::ErrorCode::invalid_argument, encode(q, 3276.8).error().code);
  EXPECT_THAT(describe(encode(q, 5000.0).error()),
              HasSubstr("5000 does not fit: it holds -3276.8 to 3276.7"));
  EXPECT_TRUE(encode(q, -3276.8));
  EXPECT_FALSE(encode(q, std::nan("")));
  EXPECT_FALSE(check(quantity(RegisterType::u16, WordOrder::high_first, 0.0)));
  ModbusRegister last = quantity(RegisterType::u32);
  last.address = 65535;
  EXPECT_FALSE(check(last));
}

RC_GTEST_PROP(ModbusRegister, WhatIsWrittenIsReadBackToHalfAStep, ()) {
  const auto type = *rc::gen::element(RegisterType::u16, RegisterType::i16, RegisterType::u32,
                                      RegisterType::i32, RegisterType::f32);
  const auto order = *rc::gen::element(WordOrder::high_first, WordOrder::low_first);
  const double scale = *rc::gen::element(0.01, -0.5, 1.0, 4.0);
  const auto q = quantity(type, order, scale);
  const double value = scale * *rc::gen::inRange(0, 32767) + *rc::gen::element(0.0, 0.3 * scale);
  const auto raw = encode(q, value);
  RC_ASSERT(raw.has_value());
  RC_ASSERT(std::abs(decode(q, *raw).value() - value) <=
            (type == RegisterType::f32 ? 1e-6 * std::abs(value) : 0.5 * std::abs(scale)) + 1e-9);
}

TEST(ModbusRegister, ErrorsOfTheBusNameTheQuantity) {
  mocks::FakeModbus bus(3);
  bus.holding = {{10, 1}, {11, 2}};
  EXPECT_DOUBLE_EQ(65538.0, read(bus, 3, quantity(RegisterType::u32)).value());
  ASSERT_TRUE(write(bus, 3, quantity(RegisterType::u32, WordOrder::low_first), 65538.0));
  EXPECT_EQ(2, bus.holding[10]);
  EXPECT_EQ(1, bus.holding[11]);
  EXPECT_THAT(describe(read(bus, 9, quantity(RegisterType::u16)).error()), HasSubstr("(speed): no answer"));
  ModbusRegister input = quantity(RegisterType::u16);
  input.table = RegisterTable::input;
  EXPECT_EQ(hal::ErrorCode::refused, read(bus, 3, input).error().code);
  EXPECT_EQ(hal::ErrorCode::invalid_argument, write(bus, 3, input, 1.0).error().code);
}

}  // namespace
}  // namespace forager::servo
