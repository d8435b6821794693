#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/sim_battery_gauge.hpp"
#include "mocks/sim_docking_charger.hpp"
#include "mocks/sim_linear_actuator.hpp"
#include "mocks/sim_modbus_bus.hpp"
#include "servo/modbus_battery.hpp"
#include "servo/modbus_brake.hpp"
#include "servo/modbus_charger.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using mocks::SimBatteryGauge;
using mocks::SimDockingCharger;
using mocks::SimLinearActuator;
using testing::HasSubstr;

ModbusRegister input(const char* name, std::uint16_t address, RegisterType type, double scale) {
  return {.name = name, .address = address, .table = RegisterTable::input, .type = type, .scale = scale};
}

// Three devices on one line, in virtual time.
class ModbusDevicesTest : public testing::Test {
 protected:
  ModbusDevicesTest() {
    for (mocks::SimModbusSlave* slave : {&gauge_.slave(), &dock_.slave(), &actuator_.slave()})
      bus_.attach(*slave);
  }
  template <class Update>
  void live(hal::Duration time, Update update) {
    for (const hal::Instant end = now_ + time; now_ < end; now_ += 20ms) {
      update();
      gauge_.update(now_);
      dock_.update(now_);
      actuator_.update(now_);
    }
  }
  hal::Instant now_{1s};
  mocks::SimModbusBus bus_;
  SimBatteryGauge gauge_;
  SimDockingCharger dock_;
  SimLinearActuator actuator_;
  ModbusBattery battery_ =
      ModbusBattery::create(
          bus_, {.unit = 4,
                 .voltage = input("voltage", SimBatteryGauge::kVoltage, RegisterType::u16, 0.01),
                 .charge = input("charge", SimBatteryGauge::kCharge, RegisterType::f32, 0.01),
                 .current = input("current", SimBatteryGauge::kCurrent, RegisterType::i16, 0.1),
                 .temperature = input("temperature", SimBatteryGauge::kTemperature, RegisterType::i16, 0.1)})
          .value();
  ModbusCharger charger_ =
      ModbusCharger::create(
          bus_, {.unit = 5,
                 .status = input("status", SimDockingCharger::kStatus, RegisterType::u16, 1.0),
                 .enable_coil = SimDockingCharger::kEnable,
                 .current = input("current", SimDockingCharger::kCurrent, RegisterType::u16, 0.01)})
          .value();
};

TEST_F(ModbusDevicesTest, TheGaugeIsReadWholeAndOneExchangeAtATime) {
  gauge_.current_a = -12.5;
  gauge_.temperature_c = -7.5;
  gauge_.update(now_);
  for (int i = 0; i < 4; ++i) {
    EXPECT_FALSE(battery_.reading());
    const auto before = bus_.exchanges;
    ASSERT_TRUE(battery_.update(now_ += 10ms));
    EXPECT_EQ(before + 1, bus_.exchanges);
  }
  ASSERT_TRUE(battery_.reading());
  EXPECT_NEAR(gauge_.voltage_v(), battery_.reading()->voltage_v, 0.006);
  EXPECT_NEAR(0.8, battery_.reading()->charge, 1e-6);
  EXPECT_NEAR(-12.5, battery_.reading()->current_a.value(), 1e-9);
  EXPECT_NEAR(-7.5, battery_.reading()->temperature_c.value(), 1e-9);
  ASSERT_TRUE(battery_.update(now_ += 10ms));
  EXPECT_EQ(4U, bus_.exchanges) << "not before the next second";
}

TEST_F(ModbusDevicesTest, AGaugeThatWentSilentIsStaleInTime) {
  live(2s, [&] { ASSERT_TRUE(battery_.update(now_)); });
  EXPECT_FALSE(battery_.stale(now_));
  gauge_.slave().fault = mocks::SimModbusSlave::Fault::silent;
  hal::Result<> last;
  live(6500ms, [&] {
    if (auto updated = battery_.update(now_); !updated) last = std::move(updated);
  });
  ASSERT_FALSE(last);
  EXPECT_EQ(hal::ErrorCode::timeout, last.error().code);
  EXPECT_THAT(describe(last.error()), HasSubstr("modbus sim: read registers 0 to 0 of unit 4 (voltage)"));
  EXPECT_TRUE(battery_.stale(now_));
  gauge_.slave().fault = mocks::SimModbusSlave::Fault::none;
  live(2s, [&] { static_cast<void>(battery_.update(now_)); });
  EXPECT_FALSE(battery_.stale(now_));
}

TEST_F(ModbusDevicesTest, AWrongScaleOfTheChargeIsNotTakenForAFullBattery) {
  auto wrong = ModbusBattery::create(
                   bus_, {.unit = 4,
                          .voltage = input("voltage", SimBatteryGauge::kVoltage, RegisterType::u16, 0.01),
                          .charge = input("charge", SimBatteryGauge::kCharge, RegisterType::f32, 1.0)})
                   .value();
  ASSERT_TRUE(wrong.update(now_));
  const auto refused = wrong.update(now_);
  EXPECT_EQ(hal::ErrorCode::protocol, refused.error().code);
  EXPECT_FALSE(wrong.reading());
}

TEST_F(ModbusDevicesTest, ChargingFillsTheBatteryAndLeavingTheDockOpensTheContacts) {
  dock_.docked = true;
  const double before = gauge_.charge();
  live(60s, [&] {
    charger_.charge_until(now_ + 500ms);
    ASSERT_TRUE(charger_.update(now_));
    gauge_.current_a = dock_.current_a();
  });
  EXPECT_TRUE(charger_.reading()->charging);
  EXPECT_NEAR(5.0, charger_.reading()->current_a.value(), 0.01);
  EXPECT_NEAR(before + 5.0 * 59.5 / 36000.0, gauge_.charge(), 2e-4);
  dock_.docked = false;
  live(400ms, [&] {
    charger_.charge_until(now_ + 500ms);
    ASSERT_TRUE(charger_.update(now_));
  });
  EXPECT_FALSE(dock_.live());
  EXPECT_EQ(false, charger_.enabled());
}

TEST_F(ModbusDevicesTest, ContactsStayDeadWithoutARobotAndWithoutACommand) {
  live(1s, [&] {
    charger_.charge_until(now_ + 500ms);
    ASSERT_TRUE(charger_.update(now_));
    ASSERT_FALSE(dock_.live());
  });
  EXPECT_FALSE(charger_.reading()->fault) << "the coil was never on without a robot";
  dock_.docked = true;
  live(1s, [&] { ASSERT_TRUE(charger_.update(now_)); });
  EXPECT_FALSE(dock_.live()) << "the last command had run out before the contactor closed";
}

TEST_F(ModbusDevicesTest, ACommandRunsOutAndHaltSwitchesOffAtOnce) {
  dock_.docked = true;
  charger_.charge_until(now_ + 2s);
  live(1500ms, [&] { ASSERT_TRUE(charger_.update(now_)); });
  EXPECT_TRUE(dock_.live());
  live(1s, [&] { ASSERT_TRUE(charger_.update(now_)); });
  EXPECT_FALSE(dock_.live());
  charger_.charge_until(now_ + 10s);
  live(1s, [&] { ASSERT_TRUE(charger_.update(now_)); });
  EXPECT_TRUE(dock_.live());
  charger_.halt();
  EXPECT_FALSE(dock_.slave().coils[SimDockingCharger::kEnable]);
}

TEST_F(ModbusDevicesTest, TheActuatorFollowsItsDriverAndLocksWhenTheLineDies) {
  auto brake = ModbusBrake::create(bus_, {.unit = 3,
                                          .target = {.address = SimLinearActuator::kTarget},
                                          .open_value = 400,
                                          .locked_value = 100,
                                          .measured = ModbusRegister{.address = SimLinearActuator::kPosition,
                                                                     .table = RegisterTable::input},
                                          .enable_coil = SimLinearActuator::kEnable,
                                          .slew_per_s = 5.0})
                   .value();
  live(1s, [&] { ASSERT_TRUE(brake.move(0.0, now_)); });
  EXPECT_NEAR(40.0, actuator_.position_mm(), 0.1);
  EXPECT_NEAR(0.0, brake.measured().value(), 0.01);
  actuator_.jammed = true;
  live(1s, [&] { ASSERT_TRUE(brake.move(1.0, now_)); });
  EXPECT_NEAR(0.0, brake.measured().value(), 0.01) << "the sensor tells what the command does not";
  actuator_.jammed = false;
  live(1s, [&] { ASSERT_TRUE(brake.move(0.0, now_)); });
  bus_.unplug();
  hal::Result<> moved;
  live(2s, [&] { moved = brake.move(0.0, now_); });
  EXPECT_EQ(hal::ErrorCode::disconnected, moved.error().code);
  EXPECT_NEAR(10.0, actuator_.position_mm(), 0.1) << "by its own time-out";
}

TEST_F(ModbusDevicesTest, EveryWayALineFailsHasItsOwnError) {
  using Fault = mocks::SimModbusSlave::Fault;
  const auto error = [&](Fault fault) {
    gauge_.slave().fault = fault;
    return read(bus_, 4, input("voltage", 0, RegisterType::u16, 1.0)).error();
  };
  EXPECT_EQ(hal::ErrorCode::timeout, error(Fault::silent).code);
  EXPECT_THAT(error(Fault::wrong_crc).detail, HasSubstr("CRC"));
  EXPECT_THAT(error(Fault::wrong_unit).detail, HasSubstr("another unit"));
  gauge_.slave().fault = Fault::none;
  gauge_.slave().exception_next = 4;
  EXPECT_EQ(hal::ErrorCode::refused, read(bus_, 4, input("voltage", 0, RegisterType::u16, 1.0)).error().code);
  bus_.unplug();
  EXPECT_EQ(hal::ErrorCode::disconnected,
            read(bus_, 4, input("voltage", 0, RegisterType::u16, 1.0)).error().code);
}

}  // namespace
}  // namespace forager::servo
