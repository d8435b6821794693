#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/hid_bus.hpp"

namespace forager::hal {
namespace {

using testing::HasSubstr;

TEST(AbsentHid, SaysWhatToInstall) {
  const auto bus = open_hid_bus();
  ASSERT_FALSE(bus.has_value());
  EXPECT_EQ(ErrorCode::unsupported, bus.error().code);
  EXPECT_THAT(describe(bus.error()), HasSubstr("libhidapi-dev"));
  EXPECT_THAT(hid_library(), HasSubstr("built without"));
}

}  // namespace
}  // namespace forager::hal
