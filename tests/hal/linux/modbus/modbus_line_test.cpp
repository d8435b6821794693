#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/modbus_bus.hpp"
#include "hal/linux/serial_port.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/linux/modbus/line_pump.hpp"
#include "tests/hal/linux/modbus/served_slave.hpp"

namespace forager::hal {
namespace {

using namespace std::chrono_literals;
using contract::LineFault;
using testing::HasSubstr;

// libmodbus, a cable with faults, and an emulated slave: nothing but bytes between them.
class ModbusLineTest : public testing::Test {
 protected:
  ModbusLineTest() {
    slave_.with_device([](auto& device) { device.holding = {{10, 0x1234}, {11, 0x5678}}; });
  }
  Error error_with(LineFault fault) {
    line_.spoil(fault);
    const auto read = bus_->read_holding(7, 10, two_);
    return read ? Error{ErrorCode::invalid_state, {}, {}, "it worked", {}, 0} : read.error();
  }
  // The slave opens its end in a thread of its own.
  bool comes_up() {
    for (int tries = 0; tries < 20; ++tries)
      if (works()) return true;
    return false;
  }
  bool works() {
    two_ = {};
    return bus_->read_holding(7, 10, two_) && two_ == std::array<std::uint16_t, 2>{0x1234, 0x5678};
  }
  const mocks::VirtualClock clock_;
  contract::LinePump line_;
  contract::ServedSlave slave_{open_serial_port({.device = line_.far()}, clock_), 7};
  std::unique_ptr<Modbus> bus_ =
      open_modbus_rtu({.device = line_.near(), .baud = 115200, .parity = 'N', .timeout = 500ms}).value();
  std::array<std::uint16_t, 2> two_{};
};

TEST_F(ModbusLineTest, DroppedAndFlippedBytesAreToldApartAndNothingStays) {
  ASSERT_TRUE(comes_up());
  const Error silent = error_with(LineFault::drop);
  EXPECT_EQ(ErrorCode::timeout, silent.code);
  EXPECT_THAT(describe(silent), HasSubstr("read registers 10 to 11 of unit 7: no answer"));
  EXPECT_TRUE(works());
  const Error flipped = error_with(LineFault::flip_a_bit);
  EXPECT_EQ(ErrorCode::protocol, flipped.code);
  EXPECT_THAT(flipped.detail, HasSubstr("CRC"));
  EXPECT_TRUE(works());
  const ErrorCode cut = error_with(LineFault::drop_a_byte).code;
  EXPECT_TRUE(cut == ErrorCode::timeout || cut == ErrorCode::protocol);
  EXPECT_TRUE(works());
}

TEST_F(ModbusLineTest, ASlowSlaveIsNotASilentOneAndItsAnswerIsNotTheNextOnes) {
  line_.delay = 800ms;
  ASSERT_TRUE(comes_up());
  EXPECT_EQ("no answer", error_with(LineFault::delay).detail);
  std::this_thread::sleep_for(600ms);  // now it lies there
  slave_.with_device([](auto& device) { device.holding[10] = 0x4321; });
  ASSERT_TRUE(bus_->read_holding(7, 10, two_));
  EXPECT_EQ(0x4321, two_[0]) << "the late answer was taken for this one";
  EXPECT_EQ("no answer", error_with(LineFault::delay).detail) << "in between it was in time";
  std::this_thread::sleep_for(600ms);
  const Error late = error_with(LineFault::delay);
  EXPECT_EQ(ErrorCode::timeout, late.code);
  EXPECT_THAT(describe(late),
              HasSubstr("the answer comes, but later than the 500 ms it is waited for. Raise timeout_ms"));
}

}  // namespace
}  // namespace forager::hal
