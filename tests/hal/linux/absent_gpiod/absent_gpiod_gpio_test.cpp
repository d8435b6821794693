#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/linux/bare_calls.hpp"
#include "hal/linux/gpio.hpp"

namespace forager::hal {
namespace {

using testing::HasSubstr;

template <class T>
void expect_absent(const Result<T>& result) {
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(ErrorCode::unsupported, result.error().code);
  EXPECT_THAT(describe(result.error()), HasSubstr("built without libgpiod"));
  EXPECT_THAT(describe(result.error()), HasSubstr("libgpiod-dev"));
}

TEST(AbsentGpio, EveryWayInSaysWhatToInstall) {
  const GpioLineConfig line{.chip = "gpiochip0", .line = "GPIO17"};
  expect_absent(open_gpio_out(line));
  expect_absent(open_gpio_in(line));
  expect_absent(open_gpio_edges(line));
  expect_absent(open_gpio_group({line}));
  expect_absent(list_gpio());
  expect_absent(open_bare_gpio("/dev/gpiochip0", 17));
}

}  // namespace
}  // namespace forager::hal
