#include "servo/digital_brake.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mocks/fake_digital_out.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;

TEST(DigitalBrake, IsLockedByLettingGoOfASpringAppliedOne) {
  mocks::FakeDigitalOut line("gpio BRAKE_LEFT");
  DigitalBrake brake(line, WhenActive::opens);
  ASSERT_TRUE(brake.move(0.0, hal::Instant(1s)));
  EXPECT_TRUE(line.active());
  ASSERT_TRUE(brake.move(0.49, hal::Instant(1s)));
  EXPECT_TRUE(line.active());
  ASSERT_TRUE(brake.move(0.5, hal::Instant(1s)));
  EXPECT_FALSE(line.active());
  ASSERT_TRUE(brake.move(0.0, hal::Instant(1s)));
  brake.halt();
  EXPECT_FALSE(line.active());
  EXPECT_EQ(hal::ErrorCode::invalid_argument, brake.move(std::nan(""), hal::Instant(1s)).error().code);
}

TEST(DigitalBrake, IsLockedByCurrentWhereTheBoardSaysSo) {
  mocks::FakeDigitalOut line("gpio BRAKE_LEFT");
  DigitalBrake brake(line, WhenActive::locks);
  brake.halt();
  EXPECT_TRUE(line.active());
  EXPECT_DOUBLE_EQ(1.0, brake.commanded());
}

}  // namespace
}  // namespace forager::servo
