// What a guard does to the outputs of a program that is gone: on the real backends, above a fake kernel.
#include "boards/guard_outputs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "boards/board.hpp"
#include "boards/esc_bench.hpp"
#include "flight/esc_bank.hpp"
#include "hal/linux/i2c_dev.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/text_journal.hpp"
#include "servo/pca9685.hpp"
#include "tests/hal/linux/fake_gpio_kernel.hpp"
#include "tests/hal/linux/fake_i2c_node.hpp"
#include "tests/hal/linux/fake_kernel.hpp"
#include "tests/hal/linux/fake_pwm_chip.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

// Virtual time in which the chip lives, too, and in which something may happen at a given moment.
class LivingClock final : public hal::Clock {
 public:
  explicit LivingClock(mocks::SimPca9685& chip) : chip_(&chip) {}
  void at(hal::Instant when, std::function<void()> what) { event_ = {when, std::move(what)}; }

 private:
  [[nodiscard]] hal::Instant do_now() const override { return now_; }
  void do_sleep_until(hal::Instant when) override {
    now_ = std::max(now_, when);
    chip_->advance(now_);
    if (event_.second && now_ >= event_.first) std::exchange(event_.second, nullptr)();
  }
  mocks::SimPca9685* chip_;
  hal::Instant now_{1s};
  std::pair<hal::Instant, std::function<void()>> event_;
};

class GuardOutputs : public testing::Test {
 protected:
  GuardOutputs() {
    auto& gpio = hal::fake::FakeGpio::get();
    gpio.reset();
    gpio.chips[0].label = "pinctrl-bcm2711";
    for (int i = 0; i < 28; ++i) gpio.chips[0].lines.push_back({.name = "GPIO" + std::to_string(i)});
    wires_.attach(0x40, pca9685_);
    kernel_.files["/dev/i2c-1"] = std::make_shared<hal::fake::FakeI2cNode>(wires_);
  }
  Board board(const std::string& text) {
    const auto loaded = load_board(folder_.write("board.toml", "[board]\nname = \"robot\"\n" + text));
    EXPECT_TRUE(loaded) << describe(loaded.error());
    return loaded.value_or(Board{});
  }
  std::vector<SafeOutput> make_safe(const Board& board, OutputScope scope = {.brakes = true, .escs = true}) {
    return make_outputs_safe(board, scope, clock_, &kernel_);
  }
  static hal::fake::GpioLine& line(std::size_t i) { return hal::fake::FakeGpio::get().chips[0].lines[i]; }

  test::ScratchFolder folder_;
  mocks::SimPca9685 pca9685_;
  LivingClock clock_{pca9685_};
  hal::fake::FakeKernel kernel_;
  hal::fake::FakePwmChip chip_{kernel_, clock_, "pwmchip0", 2};
  mocks::SimI2cBus wires_{"wires"};
};

TEST_F(GuardOutputs, KernelPulsesOfADeadProgramBecomeTheLockedOnes) {
  for (const std::size_t i : {0U, 1U}) {
    chip_.export_now(i);
    chip_.line(i) = {.period = 20'000'000,
                     .duty = 1'180'000,
                     .enabled = true,
                     .exported = true,
                     .writable_from = hal::Instant()};
  }
  const auto outcome = make_safe(board(R"([brakes]
left = { backend = "sysfs_pwm", channel = 0 }
right = { backend = "sysfs_pwm", channel = 1 }
)"));
  ASSERT_EQ(outcome.size(), 2U);
  EXPECT_FALSE(outcome[0].error || outcome[1].error);
  EXPECT_EQ(chip_.line(0).duty, 1'725'000);
  EXPECT_EQ(chip_.line(1).duty, 1'875'000);
}

TEST_F(GuardOutputs, ALineThatADyingProcessStillHoldsIsTriedAgain) {
  line(17).used = true;
  line(17).consumer = "forager";
  clock_.at(clock_.now() + 30ms, [] { line(17).used = false; });
  const auto outcome = make_safe(board(R"([brakes]
left = { backend = "gpio", chip = "pinctrl-bcm2711", line = "GPIO17", when_active = "locks" }
right = { backend = "gpio", chip = "pinctrl-bcm2711", line = "GPIO27", active_low = true }
)"));
  ASSERT_EQ(outcome.size(), 2U);
  EXPECT_FALSE(outcome[0].error || outcome[1].error);
  EXPECT_TRUE(line(17).level) << "current locks it, and it keeps its level";
  EXPECT_TRUE(line(27).level) << "no current: its spring locks it";
}

TEST_F(GuardOutputs, WhoeverKeepsALineIsNamedAndTheOtherBrakeIsLocked) {
  line(17).used = true;
  line(17).consumer = "pwm-fan";
  const auto outcome = make_safe(board(R"([brakes]
left = { backend = "gpio", chip = "pinctrl-bcm2711", line = "GPIO17" }
right = { backend = "gpio", chip = "pinctrl-bcm2711", line = "GPIO27", when_active = "locks" }
)"));
  ASSERT_EQ(outcome.size(), 2U);
  ASSERT_TRUE(outcome[0].error.has_value());
  EXPECT_THAT(describe(*outcome[0].error), HasSubstr("\"pwm-fan\" holds the line"));
  EXPECT_FALSE(outcome[1].error);
  EXPECT_TRUE(line(27).level);
}

constexpr const char* kOneChipForAll = R"([brakes]
left = { backend = "pca9685", channel = 4 }
right = { backend = "pca9685", channel = 5 }
[esc]
output = "pca9685"
motor = [{ name = "left", channel = 0 }, { name = "right", channel = 1 }]
)";

// Brakes and ESCs on one chip that goes on with its last pulses: none of them may lose its pulses while the
// others are told.
TEST_F(GuardOutputs, AChipThatRunsIsTakenOverWithAllItsOutputs) {
  const Board all = board(kOneChipForAll);
  mocks::TextJournal journal;
  const auto wires = hal::open_i2c_dev({.device = "/dev/i2c-1"}, kernel_);
  ASSERT_TRUE(wires);
  servo::Pca9685 before(**wires, nullptr, journal, {});
  ASSERT_TRUE(before.open(clock_.now()));
  for (int i = 0; i < 3; ++i) {
    clock_.sleep_until(clock_.now() + 1ms);
    ASSERT_TRUE(before.update(clock_.now()));
  }
  for (const std::size_t channel : {0U, 1U, 4U, 5U, 9U})
    ASSERT_TRUE(before.channel(channel).set_pulse(channel < 2 ? 1300us : 1180us));
  const auto outcome = make_safe(all);
  ASSERT_EQ(outcome.size(), 3U);
  for (const SafeOutput& output : outcome) EXPECT_FALSE(output.error) << output.output;
  const auto near = [this](std::size_t channel, hal::Duration wanted) {
    const auto pulse = pca9685_.pulse(channel);
    return pulse && std::chrono::abs(*pulse - wanted) < 5us;
  };
  EXPECT_TRUE(near(0, 1000us) && near(1, 1000us));
  EXPECT_TRUE(near(4, 1725us));
  EXPECT_TRUE(near(5, 1875us));
  EXPECT_TRUE(near(9, 1180us)) << "not ours: it goes on";
}

TEST_F(GuardOutputs, AChipThatWasResetIsStartedAndThenTold) {
  const auto outcome = make_safe(board(kOneChipForAll));
  for (const SafeOutput& output : outcome) EXPECT_FALSE(output.error) << output.output;
  for (const std::size_t channel : {0U, 1U, 4U, 5U})
    EXPECT_TRUE(pca9685_.pulse(channel).has_value()) << channel;
}

TEST_F(GuardOutputs, OnlyWhatTheProgramMovedIsTouched) {
  const Board all = board(kOneChipForAll);
  EXPECT_EQ(make_safe(all, {.brakes = true}).size(), 2U);
  EXPECT_FALSE(pca9685_.pulse(0).has_value());
  EXPECT_TRUE(has_real_outputs(all, {.brakes = true}));
  EXPECT_FALSE(has_real_outputs(sim_board(), {.brakes = true, .escs = true}));
  EXPECT_TRUE(make_safe(sim_board()).empty());
}

// ESCs on a PCA9685 arm by the same rules as on every other output.
class EscsOnAChip : public GuardOutputs {
 protected:
  EscsOnAChip() : board_(board(kOneChipForAll)) {
    auto bench = open_esc_bench(board_.esc, clock_, journal_, EscStart::anew, &kernel_);
    EXPECT_TRUE(bench) << describe(bench.error());
    bench_ = *std::move(bench);
    auto bank = flight::EscBank::create(bay_.claim("test").value(), bench_->group(), bench_->lines(),
                                        bench_->power(), journal_, board_.esc.bank, clock_.now());
    EXPECT_TRUE(bank) << describe(bank.error());
    bank_ = *std::move(bank);
  }
  hal::Result<> tick() {
    clock_.sleep_until(clock_.now() + 10ms);
    auto lives = bench_->advance(clock_.now());
    if (lives) bank_->update(clock_.now());
    return lives;
  }
  void arm() {
    ASSERT_TRUE(bank_->arm(flight::PropsOff::confirm(std::string(flight::PropsOff::kSentence)).value(),
                           clock_.now()));
    for (int i = 0; i < 1000 && bank_->state() == flight::EscState::arming; ++i) ASSERT_TRUE(tick());
    ASSERT_EQ(bank_->state(), flight::EscState::armed);
  }
  [[nodiscard]] double pulse_us(std::size_t channel) const {
    return static_cast<double>(pca9685_.pulse(channel).value_or(0ns).count()) / 1e3;
  }

  mocks::TextJournal journal_;
  Board board_;
  flight::MotorBay bay_;
  std::unique_ptr<EscBench> bench_;
  std::unique_ptr<flight::EscBank> bank_;
};

TEST_F(EscsOnAChip, ArmThrottleAndStop) {
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(tick());
  EXPECT_NEAR(pulse_us(0), 1000.0, 2.5) << "the stop pulse before anything else";
  arm();
  EXPECT_NEAR(pulse_us(0), 1060.0, 2.5);
  constexpr std::array kThrottle{0.2, 0.0};
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(bank_->command(kThrottle, clock_.now()));
    ASSERT_TRUE(tick());
  }
  EXPECT_NEAR(pulse_us(0), 1220.0, 2.5);
  EXPECT_NEAR(pulse_us(1), 1060.0, 2.5);
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(tick());
  EXPECT_EQ(bank_->state(), flight::EscState::stopped) << "no command for 100 ms";
  EXPECT_NEAR(pulse_us(0), 1000.0, 2.5);
}

TEST_F(EscsOnAChip, AChipThatLostItsSupplyIsAFailure) {
  arm();
  pca9685_.power_cycle();
  hal::Result<> lives;
  for (int i = 0; i < 30 && lives; ++i) lives = tick();
  ASSERT_FALSE(lives) << "within 300 ms";
  EXPECT_THAT(describe(lives.error()), HasSubstr("lost its supply"));
  bank_->halt();
  for (int i = 0; i < 3; ++i) {
    clock_.sleep_until(clock_.now() + 10ms);
    ASSERT_TRUE(bench_->advance(clock_.now()));
  }
  EXPECT_NEAR(pulse_us(0), 1000.0, 2.5);
}

}  // namespace
}  // namespace forager::boards
