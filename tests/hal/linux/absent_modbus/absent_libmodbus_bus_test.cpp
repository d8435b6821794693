#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/modbus_bus.hpp"

namespace forager::hal {
namespace {

using testing::HasSubstr;

TEST(AbsentModbus, EveryWayInSayWhatToInstall) {
  for (const auto& bus : {open_modbus_rtu({.device = "/dev/ttyUSB0"}).error(),
                          open_modbus_tcp({.host = "192.168.1.30"}).error(),
                          open_bare_modbus({.device = "/dev/ttyUSB0"}, 1, 4).error()}) {
    EXPECT_EQ(ErrorCode::unsupported, bus.code);
    EXPECT_THAT(describe(bus), HasSubstr("built without libmodbus"));
    EXPECT_THAT(describe(bus), HasSubstr("libmodbus-dev"));
  }
}

}  // namespace
}  // namespace forager::hal
