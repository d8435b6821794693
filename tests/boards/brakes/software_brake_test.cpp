// Brake servos on GPIO lines, their pulses made by the real thread through the real GPIO backend: from the
// board file to the level at the pin. What the pins did is looked at when the thread is gone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "boards/board.hpp"
#include "boards/brake_devices.hpp"
#include "boards/guard_outputs.hpp"
#include "boards/run_clock.hpp"
#include "mocks/text_journal.hpp"
#include "tests/hal/linux/fake_gpio_kernel.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr const char* kLines = R"([board]
name = "robot"
[brakes]
frequency_hz = 100
left = { backend = "software_pwm", chip = "pinctrl-bcm2711", line = "GPIO17" }
right = { backend = "software_pwm", chip = "pinctrl-bcm2711", line = "GPIO27", active_low = true }
)";

class SoftwareBrakes : public testing::Test {
 protected:
  SoftwareBrakes() {
    auto& gpio = hal::fake::FakeGpio::get();
    gpio.reset();
    gpio.chips[0].label = "pinctrl-bcm2711";
    for (int i = 0; i < 28; ++i) gpio.chips[0].lines.push_back({.name = "GPIO" + std::to_string(i)});
    board_ = load_board(folder_.write("board.toml", kLines)).value();
  }
  static const hal::fake::GpioLine& line(std::size_t i) {
    return hal::fake::FakeGpio::get().chips[0].lines[i];
  }
  static long pulses(std::size_t i, bool active_level) {
    const auto& history = line(i).history;
    return std::count(history.begin(), history.end(), active_level);
  }

  test::ScratchFolder folder_;
  Board board_;
  std::unique_ptr<hal::Clock> clock_ = make_real_clock(1.0);
  mocks::TextJournal journal_;
};

TEST_F(SoftwareBrakes, PulsesReachBothPinsAndEndWithTheObject) {
  {
    const auto devices = open_brake_devices(board_.brakes, {.clock = *clock_, .journal = journal_});
    ASSERT_TRUE(devices) << describe(devices.error());
    ASSERT_TRUE((*devices)->left().move(1.0, clock_->now()));
    ASSERT_TRUE((*devices)->right().move(1.0, clock_->now()));
    EXPECT_THAT((*devices)->left_text(), HasSubstr("1725.0 us"));
    for (int i = 0; i < 30; ++i) {
      std::this_thread::sleep_for(10ms);
      ASSERT_TRUE((*devices)->update(clock_->now()));
    }
  }
  EXPECT_GE(pulses(17, true), 1);
  EXPECT_GE(pulses(27, false), 1);
  EXPECT_FALSE(line(17).level);
  EXPECT_TRUE(line(27).level) << "inactive is high there";
  EXPECT_EQ(hal::fake::FakeGpio::get().open_handles(), 0U);
  EXPECT_EQ(journal_.count("too long by"), 1U);
}

TEST_F(SoftwareBrakes, ALineThatSomebodyHoldsIsNamed) {
  hal::fake::FakeGpio::get().chips[0].lines[27].used = true;
  hal::fake::FakeGpio::get().chips[0].lines[27].consumer = "pwm-fan";
  const auto devices = open_brake_devices(board_.brakes, {.clock = *clock_, .journal = journal_});
  ASSERT_FALSE(devices);
  EXPECT_THAT(describe(devices.error()), HasSubstr("\"pwm-fan\" holds the line"));
}

TEST_F(SoftwareBrakes, AGuardPressesOneForTwoSecondsAndLetsTheLineGo) {
  board_.brakes.right = {.backend = BrakeBackend::sim};  // one thread alone: the fake kernel has no lock
  const auto outcome = make_outputs_safe(board_, {.brakes = true}, *clock_);
  ASSERT_EQ(outcome.size(), 1U);
  EXPECT_FALSE(outcome[0].error);
  EXPECT_GE(pulses(17, true), 10);
  EXPECT_FALSE(line(17).level);
  EXPECT_EQ(hal::fake::FakeGpio::get().open_handles(), 0U);
}

}  // namespace
}  // namespace forager::boards
