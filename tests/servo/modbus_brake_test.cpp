#include "servo/modbus_brake.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mocks/fake_modbus.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;

class ModbusBrakeTest : public testing::Test {
 protected:
  ModbusBrakeTest() {
    bus_.holding[40] = 0;
    bus_.input[50] = 900;
    bus_.coils[1] = false;
  }
  void move(double fraction, hal::Duration time = 1s) {
    for (const hal::Instant end = now_ + time; now_ < end; now_ += 20ms) last_ = brake_.move(fraction, now_);
  }
  hal::Instant now_{1s};
  hal::Result<> last_;
  mocks::FakeModbus bus_{3};
  ModbusBrake brake_ =
      ModbusBrake::create(bus_, {.unit = 3,
                                 .target = {.address = 40},
                                 .open_value = 900,
                                 .locked_value = 100,
                                 .measured = ModbusRegister{.address = 50, .table = RegisterTable::input},
                                 .enable_coil = 1,
                                 .slew_per_s = 4.0})
          .value();
};

TEST_F(ModbusBrakeTest, MovesWithinItsSlewLimitAndEnablesFirst) {
  move(0.0, 20ms);
  EXPECT_TRUE(bus_.coils[1]);
  EXPECT_EQ(100, bus_.holding[40]);
  move(0.0, 100ms);
  EXPECT_EQ(420, bus_.holding[40]);  // 0.1 s at 4 travels per second: 0.4 of 800
  move(0.0);
  EXPECT_EQ(900, bus_.holding[40]);
  EXPECT_TRUE(last_);
}

TEST_F(ModbusBrakeTest, MeasuresInFractionsOfItsTravelAndNotTooOften) {
  bus_.input[50] = 300;
  move(1.0);
  EXPECT_DOUBLE_EQ(0.75, brake_.measured().value());
  EXPECT_LE(bus_.requests,
            15U);  // 50 moves: enable and target, both told again once, ten measurements, the first
}

TEST_F(ModbusBrakeTest, ASilentActuatorIsAFailureAndNoMeasurement) {
  move(1.0);
  bus_.disconnect();
  move(0.0);
  EXPECT_EQ(hal::ErrorCode::disconnected, last_.error().code);
  EXPECT_DOUBLE_EQ(1.0, brake_.commanded());
  bus_.disconnect(false);
  move(0.0);
  EXPECT_EQ(900, bus_.holding[40]);
}

// An actuator that counts tenths of a millimetre from -20 mm on, in two registers, the low word first.
TEST_F(ModbusBrakeTest, TargetAndPositionAreWhateverTheManualSays) {
  const ModbusRegister position{
      .address = 60, .type = RegisterType::i32, .order = WordOrder::low_first, .scale = 0.1, .offset = -20.0};
  bus_.holding[60] = bus_.holding[61] = 0;
  auto brake =
      ModbusBrake::create(
          bus_,
          {.unit = 3, .target = position, .open_value = -30.0, .locked_value = 6600.0, .measured = position})
          .value();
  ASSERT_TRUE(brake.jump(1.0, now_));  // (6600 + 20) / 0.1 = 66200 = 0x00010298
  EXPECT_EQ(0x0298, bus_.holding[60]);
  EXPECT_EQ(1, bus_.holding[61]);
  EXPECT_DOUBLE_EQ(1.0, brake.measured().value());
  ASSERT_TRUE(brake.jump(0.0, now_ + 1s));  // -10 / 0.1 = -100
  EXPECT_EQ(0xFF9C, bus_.holding[60]);
  EXPECT_EQ(0xFFFF, bus_.holding[61]);
  EXPECT_DOUBLE_EQ(0.0, brake.measured().value());
}

TEST_F(ModbusBrakeTest, HaltLocksAtOnce) {
  move(0.0);
  brake_.halt();
  EXPECT_EQ(100, bus_.holding[40]);
}

TEST_F(ModbusBrakeTest, RefusesWhatCannotBe) {
  EXPECT_EQ(hal::ErrorCode::invalid_argument, brake_.move(std::nan(""), now_).error().code);
  EXPECT_FALSE(ModbusBrake::create(bus_, {.open_value = 5, .locked_value = 5}));
  EXPECT_FALSE(ModbusBrake::create(bus_, {.slew_per_s = 0.0}));
  EXPECT_FALSE(ModbusBrake::create(bus_, {.slew_per_s = INFINITY}));
  EXPECT_FALSE(ModbusBrake::create(bus_, {.locked_value = 70000.0}));
  EXPECT_FALSE(ModbusBrake::create(bus_, {.open_value = 0.0, .locked_value = 0.4}));  // one number in a u16
  EXPECT_FALSE(ModbusBrake::create(bus_, {.target = {.table = RegisterTable::input}}));
}

}  // namespace
}  // namespace forager::servo
