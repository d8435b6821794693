#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/usb_bus.hpp"

namespace forager::hal {
namespace {

using testing::HasSubstr;

TEST(AbsentUsb, SaysWhatToInstall) {
  const auto bus = open_usb_bus();
  ASSERT_FALSE(bus.has_value());
  EXPECT_EQ(ErrorCode::unsupported, bus.error().code);
  EXPECT_THAT(describe(bus.error()), HasSubstr("libusb-1.0-0-dev"));
  EXPECT_THAT(usb_library(), HasSubstr("built without"));
  const auto bare = open_bare_usb({});
  ASSERT_FALSE(bare.has_value());
  EXPECT_THAT(describe(bare.error()), HasSubstr("libusb-1.0-0-dev"));
}

}  // namespace
}  // namespace forager::hal
