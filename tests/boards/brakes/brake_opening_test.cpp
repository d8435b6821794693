// What opening the brakes does to them, to each other, and to who has them already.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/text_journal.hpp"
#include "servo/brakes.hpp"
#include "tests/boards/brakes/brake_machine.hpp"

namespace forager::boards {
namespace {

using testing::HasSubstr;

TEST(BrakeOpening, ALineSomebodyHoldsIsNamed) {
  Machine machine;
  mocks::TextJournal journal;
  auto& line = hal::fake::FakeGpio::get().chips[0].lines[17];
  line.used = true;
  line.consumer = "pwm-fan";
  const auto devices = open_brake_devices(
      board_of("[brakes]\n[brakes.left]\n" + kGpio.left + "[brakes.right]\n" + kGpio.right),
      {.clock = machine.clock, .journal = journal});
  ASSERT_FALSE(devices);
  EXPECT_EQ(hal::ErrorCode::busy, devices.error().code);
  EXPECT_THAT(describe(devices.error()), HasSubstr("\"pwm-fan\" holds the line"));
}

// It may take a while from here until somebody commands them: what an earlier program locked stays locked.
TEST(BrakeOpening, OpeningThemLetsNoBrakeGoThatLocksWhileItsLineIsActive) {
  Machine machine;
  mocks::TextJournal journal;
  const auto& lines = hal::fake::FakeGpio::get().chips[0].lines;
  const auto devices = open_brake_devices(board_of(R"([brakes]
[brakes.left]
backend = "gpio"
chip = "pinctrl-bcm2711"
line = "GPIO17"
when_active = "locks"
[brakes.right]
backend = "gpio"
chip = "mcp2221"
line = "GP3"
active_low = true
when_active = "locks"
)"),
                                          {.clock = machine.clock, .journal = journal, .hid = &machine.hid});
  ASSERT_TRUE(devices) << describe(devices.error());
  EXPECT_TRUE(lines[17].level);
  EXPECT_FALSE(machine.bridge.level(3));
}

TEST(BrakeOpening, OpeningThemLeavesTheLockedPulsesOfAChipThatRuns) {
  Machine machine;
  mocks::TextJournal journal;
  const BrakeBoard board =
      board_of("[brakes]\n[brakes.left]\n" + kPca9685.left + "[brakes.right]\n" + kPca9685.right);
  const BrakeDeviceOptions options{.clock = machine.clock, .journal = journal, .kernel = &machine.kernel};
  {
    const auto devices = open_brake_devices(board, options);
    ASSERT_TRUE(devices) << describe(devices.error());
    servo::BrakePair pair((*devices)->left(), (*devices)->right(), journal, board.pair, machine.clock.now());
    for (int i = 0; i < 5; ++i) {
      machine.clock.advance(10ms);
      ASSERT_TRUE((*devices)->update(machine.clock.now()));
      pair.update(machine.clock.now());
      machine.pass(machine.clock.now());
    }
  }
  const auto devices = open_brake_devices(board, options);
  ASSERT_TRUE(devices) << describe(devices.error());
  for (const bool left : {true, false}) EXPECT_NEAR(1.0, kPca9685.pin(machine, left).value_or(-1.0), 0.005);
}

TEST(BrakeOpening, AChipThatIsLostKeepsTheOtherOneNotFromBeingToldToLock) {
  Machine machine;
  mocks::TextJournal journal;
  mocks::SimPca9685 second;
  machine.wires.attach(0x41, second);
  const BrakeBoard board = board_of("[brakes]\n[brakes.left]\n" + kPca9685.left + "[brakes.right]\n" +
                                    kPca9685.right + "address = 0x41\n");
  const auto devices =
      open_brake_devices(board, {.clock = machine.clock, .journal = journal, .kernel = &machine.kernel});
  ASSERT_TRUE(devices) << describe(devices.error());
  servo::BrakePair pair((*devices)->left(), (*devices)->right(), journal, board.pair, machine.clock.now());
  machine.wires.detach(0x40);
  machine.clock.advance(10ms);
  ASSERT_TRUE((*devices)->update(machine.clock.now()));
  second.advance(machine.clock.now());
  machine.clock.advance(10ms);
  const auto updated = (*devices)->update(machine.clock.now());
  ASSERT_FALSE(updated) << "the left one is lost";
  EXPECT_EQ(hal::ErrorCode::no_ack, updated.error().code);
  ASSERT_TRUE(second.pulse(5).has_value());
  EXPECT_NEAR(1.0, fraction_of(*second.pulse(5), false), 0.005);
}

TEST(BrakeOpening, WithoutAnAutopilotItsOutputsCannotBeHad) {
  Machine machine;
  mocks::TextJournal journal;
  const auto devices = open_brake_devices(
      board_of("[brakes]\n[brakes.left]\n" + kAutopilot.left + "[brakes.right]\n" + kAutopilot.right),
      {.clock = machine.clock, .journal = journal});
  ASSERT_FALSE(devices);
  EXPECT_EQ(hal::ErrorCode::invalid_state, devices.error().code);
}

}  // namespace
}  // namespace forager::boards
