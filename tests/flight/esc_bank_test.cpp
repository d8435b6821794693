#include "flight/esc_bank.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/flight/esc_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using mocks::SimEscState;

hal::Error bus_error() { return {hal::ErrorCode::io, "i2c", "write", "no such bus", "look at the cable"}; }

TEST(EscBank, SendsStopPulsesBeforeAnybodyAsksForAnything) {
  EscRig rig({.motors = 4});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rig.line(i), 1000us);
  EXPECT_FALSE(rig.power().active());
  rig.run(500ms);
  EXPECT_EQ(rig.bank().state(), EscState::stopped);
  EXPECT_EQ(rig.longest(), 1000us);
}

TEST(EscBank, StopPulsesAreOnTheLineBeforeThePower) {
  EscRig rig({.period = 20ms});
  rig.arm();
  const auto stop = rig.channel().changes().front();
  const auto power = rig.power().edges().back();
  ASSERT_TRUE(power.active);
  EXPECT_GE(power.at - stop.at, 11 * 20ms);
}

TEST(EscBank, ArmsAnEscAtEveryRate) {
  for (const hal::Duration period : {20000us, 10000us, 5000us, 2500us, 2050us}) {
    EscRig rig({.period = period, .motors = 2});
    rig.arm();
    EXPECT_EQ(rig.esc(0).state(), SimEscState::armed) << period.count();
    EXPECT_EQ(rig.esc(1).state(), SimEscState::armed) << period.count();
    EXPECT_EQ(rig.longest(), 1060us);
    EXPECT_EQ(rig.esc().calibrations_begun(), 0U);
  }
}

TEST(EscBank, ArmsByOneShotToo) {
  EscRig::Options options{.period = 500us};
  options.config.pulses.protocol = EscProtocol::oneshot125;
  EscRig rig(options);
  rig.arm();
  EXPECT_TRUE(rig.esc().oneshot());
  rig.fly(0.5, 3s);
  EXPECT_NEAR(rig.esc().spin(), 0.5, 0.01);
  EXPECT_EQ(rig.line(), 182500ns) << "1460 us / 8";
}

TEST(EscBank, GivesASlowEscTheTimeToBeep) {
  EscRig rig({.period = 2500us, .beeps = 1900ms});
  rig.arm();
  EXPECT_EQ(rig.esc().state(), SimEscState::armed) << "2 s low in practice";
}

TEST(EscBank, RampsUpAndDownWithinItsRates) {
  EscRig rig({});
  rig.arm();
  double before = 0.0;
  for (int i = 0; i < 500; ++i) {
    rig.fly(1.0, 5ms);
    EXPECT_LE(rig.bank().throttle(0) - before, 0.5 * 0.005 + 1e-12);
    before = rig.bank().throttle(0);
  }
  EXPECT_EQ(rig.line(), 1860us) << "full after two seconds";
  for (int i = 0; i < 90; ++i) {
    rig.fly(0.0, 5ms);
    EXPECT_LE(before - rig.bank().throttle(0), 2.0 * 0.005 + 1e-12);
    before = rig.bank().throttle(0);
  }
  rig.fly(0.0, 100ms);
  EXPECT_EQ(rig.line(), 1060us);
}

TEST(EscBank, KeepsToItsThrottleLimit) {
  EscRig::Options options;
  options.config.most_throttle = 0.25;
  EscRig rig(options);
  rig.arm();
  rig.fly(1.0, 4s);
  EXPECT_EQ(rig.longest(), 1260us);
}

TEST(EscBank, StopsBeforeTheEscWouldWhenNobodyCommands) {
  EscRig rig({});
  rig.arm();
  rig.fly(0.4, 2s);
  const hal::Instant last = rig.now() - 5ms;  // the last command
  while (rig.bank().state() == EscState::armed) rig.step(1ms);
  EXPECT_LE(rig.now() - last, 101ms);
  EXPECT_LT(rig.now() - last, 131ms);
  EXPECT_EQ(rig.line(), 1000us);
  EXPECT_FALSE(rig.power().active());
  EXPECT_NE(rig.bank().reason().find("100 ms"), std::string::npos);
  EXPECT_FALSE(rig.bank().command(std::array{0.4}, rig.now())) << "it must be armed anew";
}

TEST(EscBank, ACommandThatComesTooLateFindsTheMotorsStopped) {
  EscRig rig({});
  rig.arm();
  rig.fly(0.4, 2s);
  rig.live(500ms);  // the program hung: no update
  const auto late = rig.bank().command(std::array{0.4}, rig.now());
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, hal::ErrorCode::invalid_state);
  EXPECT_EQ(rig.line(), 1000us);
}

TEST(EscBank, AnOutputThatDoesNotHearIsAFault) {
  EscRig rig({.switched = false, .powered = true});
  rig.arm();
  rig.fly(0.4, 2s);
  ASSERT_GT(rig.esc().spin(), 0.3);
  rig.channel().disconnect();
  rig.fly(0.5, 100ms);
  EXPECT_EQ(rig.bank().state(), EscState::faulted);
  EXPECT_NE(rig.bank().reason().find("timer"), std::string::npos) << rig.bank().reason();
}

TEST(EscBank, OneFailedLineStopsAllInTheSameUpdate) {
  EscRig rig({.motors = 4});
  rig.arm();
  rig.fly(0.3, 2s);
  rig.channel(2).fail_next(bus_error());
  rig.fly(0.4, 5ms);
  EXPECT_EQ(rig.bank().state(), EscState::faulted);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(rig.line(i), 1000us) << i;
  EXPECT_FALSE(rig.power().active());
  EXPECT_NE(rig.bank().reason().find("no such bus"), std::string::npos);
  EXPECT_FALSE(rig.bank().arm(EscRig::word(), rig.now()));
  ASSERT_TRUE(rig.bank().clear_fault(rig.now()));
  rig.arm();
}

TEST(EscBank, KeepsTellingADeadLineToStop) {
  EscRig rig({.motors = 2});
  rig.arm();
  rig.fly(0.3, 1s);
  rig.channel(1).disconnect();
  rig.fly(0.4, 100ms);
  ASSERT_EQ(rig.bank().state(), EscState::faulted);
  EXPECT_EQ(rig.line(0), 1000us);
  EXPECT_GT(rig.line(1), 1060us) << "the cable is out, the chip repeats its last pulse";
  EXPECT_FALSE(rig.bank().clear_fault(rig.now()));
  rig.channel(1).disconnect(false);
  rig.run(10ms);
  EXPECT_EQ(rig.line(1), 1000us) << "told as soon as it hears again";
}

TEST(EscBank, HaltAndTheEndLeaveStopPulses) {
  EscRig rig({.motors = 2});
  rig.arm();
  rig.fly(0.5, 2s);
  rig.bank().halt();
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(rig.line(i), 1000us);
  EXPECT_FALSE(rig.power().active());
  EXPECT_FALSE(rig.bank().arm(EscRig::word(), rig.now())) << "only after resume()";
  ASSERT_TRUE(rig.bank().resume(rig.now()));
  rig.arm();
  rig.fly(0.5, 2s);
  rig.drop_bank();
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(rig.line(i), 1000us);
  EXPECT_FALSE(rig.power().active());
  EXPECT_EQ(rig.bay().holder(), "") << "the motors are free for the autopilot";
}

TEST(EscBank, RefusesCommandsThatMakeNoSense) {
  EscRig rig({.motors = 2});
  EXPECT_FALSE(rig.bank().command(std::array{0.1, 0.1}, rig.now())) << "not armed";
  rig.arm();
  for (const double bad : {-0.1, 1.1, std::nan("")}) {
    const auto refused = rig.bank().command(std::array{0.1, bad}, rig.now());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, hal::ErrorCode::invalid_argument);
  }
  EXPECT_FALSE(rig.bank().command(std::array{0.1}, rig.now()));
  rig.run(50ms);
  EXPECT_EQ(rig.longest(), 1060us);
}

TEST(EscBank, RefusesAConfigurationThatCannotBeSafe) {
  const auto refused = [](auto change) {
    EscBankConfig config;
    change(config);
    return !validate(config, 20ms);
  };
  EXPECT_FALSE(refused([](EscBankConfig&) {}));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.command_max_age = 131ms; }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.command_max_age = 0ms; }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.arming.pulses_to_arm = 10; }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.rise_per_s = 0.0; }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.fall_per_s = std::nan(""); }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.most_throttle = 1.5; }));
  EXPECT_TRUE(refused([](EscBankConfig& c) { c.calibration.low = -1ms; }));
}

TEST(EscBank, NeedsTheMotorsAndALine) {
  mocks::FakePwmGroup group("timer", 1);
  hal::NullJournal journal;
  MotorBay bay;
  MotorAuthority motors = bay.claim("bench").value();
  const MotorAuthority elsewhere = std::move(motors);
  const auto robbed = EscBank::create(std::move(motors), group, {{"m", &group.channel(0)}}, nullptr, journal,
                                      EscBankConfig{}, {});
  ASSERT_FALSE(robbed);
  EXPECT_EQ(robbed.error().code, hal::ErrorCode::invalid_state);
  EXPECT_TRUE(group.channel(0).changes().empty()) << "nothing was sent";
  const auto lineless =
      EscBank::create(MotorBay().claim("bench").value(), group, {}, nullptr, journal, EscBankConfig{}, {});
  EXPECT_FALSE(lineless);
  const auto null = EscBank::create(MotorBay().claim("bench").value(), group, {{"m", nullptr}}, nullptr,
                                    journal, EscBankConfig{}, {});
  EXPECT_FALSE(null);
}

}  // namespace
}  // namespace forager::flight
