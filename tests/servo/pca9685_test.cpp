#include "servo/pca9685.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mocks/fake_digital_out.hpp"
#include "mocks/scripted_i2c.hpp"
#include "mocks/sim_i2c_bus.hpp"
#include "mocks/sim_pca9685.hpp"
#include "mocks/text_journal.hpp"
#include "tests/servo/pca9685_rig.hpp"

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::IsEmpty;

hal::Instant at(hal::Duration t) { return hal::Instant(t); }

double in_us(hal::Duration d) { return static_cast<double>(d.count()) / 1e3; }

// NXP data sheet PCA9685 rev. 4. 50 Hz: prescaler round(25 MHz / 4096 / 50) - 1 = 121 = 0x79, true period
// 19988.48 us; 1500 us are 307.38 ticks, so 0x133. LED0 is at 06h, ALL_LED at FAh, full off is bit 4 of
// OFF_H.
TEST(Pca9685Golden, OpensAndSetsAPulseWithTheBytesOfTheDataSheet) {
  mocks::ScriptedI2c bus([](const std::string& why) { ADD_FAILURE() << why; });
  hal::NullJournal journal;
  Pca9685 chip(bus, nullptr, journal, {.check_interval = 0ms});
  bus.expect("40 w 00 r 11")          // MODE1 after power-up: SLEEP, ALLCALL
      .expect("40 w 00 30")           // AI and SLEEP: before any burst
      .expect("40 w fa 00 00 00 10")  // all outputs full off
      .expect("40 w 01 04")           // MODE2: totem pole
      .expect("40 w fe 79")           // PRE_SCALE, asleep
      .expect("40 w fe r 79")
      .expect("40 w 00 20");  // wake
  ASSERT_TRUE(chip.open(at(0s)));
  ASSERT_TRUE(chip.channel(0).set_pulse(1500us));
  ASSERT_TRUE(chip.update(at(1ms)));
  bus.expect("40 w 00 r 20").expect("40 w 06 00 00 33 01");
  ASSERT_TRUE(chip.update(at(2ms)));
  bus.expect("40 w 42 00 00 00 10");
  ASSERT_TRUE(chip.channel(15).release());
  bus.expect("40 w 0e 00 10 00 00");
  ASSERT_TRUE(chip.channel(2).set_pulse(chip.period()));
}

class OnTheChip : public testing::Test {
 protected:
  OnTheChip() { bus_.attach(0x40, sim_); }
  void pass(hal::Duration time, hal::Duration step = 5ms) {
    for (const hal::Instant end = now_ + time; now_ < end;) {
      now_ += step;
      sim_.advance(now_);
      last_ = chip_.update(now_);
    }
  }
  void start() {
    ASSERT_TRUE(chip_.open(now_)) << describe(chip_.open(now_).error());
    pass(20ms);
    ASSERT_EQ(Pca9685::State::running, chip_.state());
  }
  hal::Instant now_{1s};
  hal::Result<> last_;
  mocks::TextJournal journal_;
  mocks::SimI2cBus bus_{"i2c"};
  mocks::SimPca9685 sim_;
  Pca9685 chip_{bus_, nullptr, journal_, {}};
};

TEST_F(OnTheChip, PowerUpMovesNothing) {
  ASSERT_TRUE(chip_.open(now_));
  for (std::size_t i = 0; i < 16; ++i) EXPECT_FALSE(sim_.pulse(i).has_value());
  pass(20ms);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_FALSE(sim_.pulse(i).has_value());
  EXPECT_THAT(sim_.violations(), IsEmpty());
}

TEST_F(OnTheChip, APulseGivenWhileTheOscillatorStartsIsMadeAfterwards) {
  ASSERT_TRUE(chip_.open(now_));
  ASSERT_TRUE(chip_.channel(3).set_pulse(1180us));
  EXPECT_FALSE(sim_.pulse(3).has_value());
  pass(20ms);
  EXPECT_EQ(chip_.channel(3).pulse(), sim_.pulse(3));
  EXPECT_THAT(sim_.violations(), IsEmpty());
}

struct Rate {
  double hz;
  double true_hz;
  double from_nominal_us;  // how wrong 1500 us would come out with ticks of the nominal period
};

// The prescaler is a whole number: the true rate is another one, and pulses must be right all the same.
TEST_F(OnTheChip, PulsesAreRightAtEveryRateAndTheTrueRateIsReported) {
  start();
  for (const Rate rate : {Rate{50.0, 50.03, 0.9}, Rate{333.0, 339.08, 26.9}, Rate{490.0, 508.63, 54.7}}) {
    ASSERT_TRUE(chip_.set_period(hal::from_seconds(1.0 / rate.hz)));
    ASSERT_TRUE(chip_.channel(0).set_pulse(1500us));
    pass(20ms);
    EXPECT_NEAR(rate.true_hz, 1.0 / hal::to_seconds(chip_.period()), 0.01);
    EXPECT_EQ(sim_.period(), chip_.period());
    const double tick_us = hal::to_seconds(chip_.period()) * 1e6 / 4096.0;
    const double error_us = std::abs(in_us(sim_.pulse(0).value()) - 1500.0);
    EXPECT_LE(error_us, tick_us / 2.0 + 0.001);
    if (rate.from_nominal_us > 10.0) {
      EXPECT_LT(error_us, rate.from_nominal_us / 10.0);
    }
  }
  EXPECT_THAT(sim_.violations(), IsEmpty());
}

TEST_F(OnTheChip, AnotherPeriodNeverMakesAPulseWithTheOldTicks) {
  start();
  ASSERT_TRUE(chip_.channel(0).set_pulse(1500us));
  for (const hal::Duration period : {3ms, 20ms, 5ms}) {
    ASSERT_TRUE(chip_.set_period(period));
    for (int i = 0; i < 40; ++i) {
      pass(100us, 100us);
      if (const auto pulse = sim_.pulse(0)) {
        EXPECT_NEAR(1500.0, in_us(*pulse), 2.5);
      }
    }
    EXPECT_TRUE(sim_.pulse(0).has_value());
  }
}

TEST_F(OnTheChip, RefusesPeriodsThePrescalerCannotDivide) {
  start();
  for (const double hz : {2000.0, 1e6, 23.0, 1.0}) {
    const auto refused = chip_.set_period(hal::from_seconds(1.0 / hz));
    ASSERT_FALSE(refused) << hz;
    EXPECT_EQ(hal::ErrorCode::unsupported, refused.error().code);
    EXPECT_THAT(refused.error().detail, HasSubstr("the chip has 3 to 255"));
  }
  EXPECT_NEAR(50.03, 1.0 / hal::to_seconds(chip_.period()), 0.01);
  for (const double hz : {1526.0, 24.0}) EXPECT_TRUE(chip_.set_period(hal::from_seconds(1.0 / hz)));
}

TEST_F(OnTheChip, AChipThatLostItsSupplyIsFoundAndMadeAnew) {
  start();
  ASSERT_TRUE(chip_.channel(0).set_pulse(1725us));
  sim_.power_cycle();
  EXPECT_FALSE(sim_.pulse(0).has_value());
  pass(300ms);
  EXPECT_EQ(1U, chip_.recoveries());
  EXPECT_EQ(chip_.channel(0).pulse(), sim_.pulse(0));
  EXPECT_EQ(1U, journal_.count("was reset (MODE1 0x11)"));
  EXPECT_THAT(sim_.violations(), IsEmpty());
}

TEST_F(OnTheChip, AbsentItSaysNoAckAndComesBackByItself) {
  bus_.detach(0x40);
  EXPECT_EQ(hal::ErrorCode::no_ack, chip_.open(now_).error().code);
  bus_.attach(0x40, sim_);
  start();
  ASSERT_TRUE(chip_.channel(0).set_pulse(1500us));
  bus_.detach(0x40);
  pass(300ms);
  EXPECT_EQ(hal::ErrorCode::invalid_state, chip_.channel(0).set_pulse(1000us).error().code);
  bus_.attach(0x40, sim_);
  pass(600ms);
  EXPECT_EQ(Pca9685::State::running, chip_.state());
  EXPECT_EQ(chip_.channel(0).pulse(), sim_.pulse(0));
  EXPECT_NEAR(1000.0, in_us(sim_.pulse(0).value()), 2.5) << "the newest wish, not the pulse it had";
}

// A brake that was to lock while the bus was disturbed must not stay open because nobody says it twice.
TEST_F(OnTheChip, AWishThatWasRefusedIsMadeAtTheNextCheck) {
  start();
  ASSERT_TRUE(chip_.channel(0).set_pulse(1180us));
  ASSERT_TRUE(chip_.channel(1).set_pulse(1500us));
  bus_.detach(0x40);
  EXPECT_EQ(hal::ErrorCode::no_ack, chip_.channel(0).set_pulse(1725us).error().code);
  EXPECT_EQ(hal::ErrorCode::no_ack, chip_.channel(1).release().error().code);
  bus_.attach(0x40, sim_);
  EXPECT_NEAR(1180.0, in_us(sim_.pulse(0).value()), 2.5);
  pass(250ms);
  EXPECT_NEAR(1725.0, in_us(sim_.pulse(0).value()), 2.5);
  EXPECT_FALSE(sim_.pulse(1).has_value());
  EXPECT_EQ(0U, chip_.recoveries());
}

TEST_F(OnTheChip, LostWhileItWakesItTakesNoPulsesUntilItIsBack) {
  ASSERT_TRUE(chip_.open(now_));
  pass(5ms);
  bus_.detach(0x40);
  pass(5ms);
  EXPECT_FALSE(last_);
  EXPECT_EQ(Pca9685::State::closed, chip_.state());
  EXPECT_EQ(hal::ErrorCode::invalid_state, chip_.channel(0).set_pulse(1725us).error().code);
  bus_.attach(0x40, sim_);
  pass(250ms);
  EXPECT_EQ(Pca9685::State::running, chip_.state());
  EXPECT_NEAR(1725.0, in_us(sim_.pulse(0).value()), 2.5);
}

// Any register keeps a byte; PRE_SCALE of something else does not.
class SomethingElse final : public mocks::SimI2cDevice {
  bool write(std::byte) override { return true; }
  std::optional<std::byte> read() override { return std::byte{0x42}; }
};

TEST_F(OnTheChip, AnotherChipAtTheAddressIsNotDriven) {
  SomethingElse other;
  bus_.attach(0x40, other);
  const auto refused = chip_.open(now_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(hal::ErrorCode::protocol, refused.error().code);
}

TEST(Pca9685Enable, OutputsStayOffUntilTheyAreDefined) {
  mocks::SimI2cBus bus("i2c");
  mocks::SimPca9685 sim;
  mocks::FakeDigitalOut enable("OE");
  hal::NullJournal journal;
  bus.attach(0x41, sim);
  Pca9685 chip(bus, &enable, journal, {.address = 0x41});
  ASSERT_TRUE(chip.open(at(0s)));
  EXPECT_FALSE(enable.active());
  ASSERT_TRUE(chip.channel(0).set_pulse(1725us));
  ASSERT_TRUE(chip.update(at(1ms)));
  EXPECT_FALSE(enable.active());
  sim.advance(at(2ms));
  ASSERT_TRUE(chip.update(at(2ms)));
  EXPECT_TRUE(enable.active());
  chip.disable();
  EXPECT_FALSE(enable.active());
}

// The emulator polices the driver; so it is tested itself.
TEST(SimPca9685, WithoutAutoIncrementABurstLandsInOneRegister) {
  mocks::SimI2cBus bus("i2c");
  mocks::SimPca9685 sim;
  bus.attach(0x40, sim);
  const std::array burst{std::byte{0x06}, std::byte{1}, std::byte{2}, std::byte{3}, std::byte{4}};
  ASSERT_TRUE(bus.write(0x40, burst));
  EXPECT_EQ(4, sim.reg(0x06));
  EXPECT_EQ(0, sim.reg(0x07));
}

TEST(SimPca9685, RefusesWhatTheDataSheetReserves) {
  mocks::SimI2cBus bus("i2c");
  mocks::SimPca9685 sim;
  bus.attach(0x40, sim);
  const auto code = [&](std::uint8_t reg, std::uint8_t value) {
    const auto done = bus.write(0x40, std::array{std::byte{reg}, std::byte{value}});
    return done ? hal::ErrorCode::io : done.error().code;
  };
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0x46, 0));
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0xF9, 0));
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0xFF, 0));
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0x00, 0x40));  // EXTCLK
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0xFE, 2));
  EXPECT_EQ(hal::ErrorCode::io, code(0xFE, 3));  // that is: taken
  EXPECT_EQ(hal::ErrorCode::io, code(0x00, 0x01));
  EXPECT_EQ(hal::ErrorCode::no_ack, code(0xFE, 100));  // awake
  EXPECT_EQ(6U, sim.violations().size());
}

// The buses are a base: they are there before the driver, and after it.
struct OneBus {
  mocks::SimI2cBus bus{"i2c"};
};
class ChipRig final : OneBus, public Pca9685Rig {
 public:
  ChipRig() : Pca9685Rig(bus, bus) {}
};

}  // namespace
}  // namespace forager::servo

namespace forager::hal::contract {
INSTANTIATE_TEST_SUITE_P(Pca9685, PwmContract,
                         testing::Values(PwmRigMaker{"OnTheEmulatedChip",
                                                     [] { return std::make_unique<servo::ChipRig>(); }}),
                         [](const auto& rig) { return rig.param.name; });
}  // namespace forager::hal::contract
