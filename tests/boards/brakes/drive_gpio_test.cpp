// The drive loop on the real GPIO backend: spring-applied brakes on two lines of a fake kernel, opened by
// current.
#include <gtest/gtest.h>

#include "tests/boards/brakes/drive_contract.hpp"
#include "tests/hal/linux/fake_gpio_kernel.hpp"

namespace forager::boards {
namespace {

using hal::fake::FakeGpio;

class FakeLines final : public DriveLines {
 public:
  FakeLines() {
    FakeGpio::get().reset();
    FakeGpio::get().chips[0] = {.label = kDriveChip,
                                .lines = {{.name = "BRAKE_LEFT"}, {.name = "BRAKE_RIGHT"}, {.name = "STOP"}}};
  }
  ~FakeLines() override { EXPECT_EQ(FakeGpio::get().open_handles(), 0U); }
  FakeLines(const FakeLines&) = delete;
  FakeLines& operator=(const FakeLines&) = delete;
  bool level(unsigned line) override { return FakeGpio::get().chips.at(0).lines.at(line).level; }
  void press_stop() override { FakeGpio::get().chips.at(0).lines[2].level = true; }
};

INSTANTIATE_TEST_SUITE_P(FakeKernel, DriveOverGpio,
                         testing::Values(DriveLinesMaker{"Libgpiod",
                                                         [] { return std::make_unique<FakeLines>(); }}),
                         [](const auto& lines) { return lines.param.name; });

}  // namespace
}  // namespace forager::boards
