#include "flight/esc_pulse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "flight/motor_authority.hpp"
#include "flight/props_off.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;

std::string refusal(const EscPulses& pulses, hal::Duration period) {
  const auto checked = validate(pulses, period);
  return checked ? std::string() : hal::describe(checked.error());
}

TEST(EscPulse, TakesFiftyToFourHundredAndNinetyHertz) {
  EXPECT_EQ(refusal({}, 20ms), "");
  EXPECT_EQ(refusal({}, 2500us), "");
  EXPECT_EQ(refusal({}, 2040816ns), "") << "490 Hz";
  EXPECT_NE(refusal({}, 2000us).find("490 Hz"), std::string::npos);
  EXPECT_NE(refusal({}, 20001us).find("outside"), std::string::npos);
}

TEST(EscPulse, APulseMustFitIntoItsPeriod) {
  EscPulses pulses;
  pulses.high = 2100us;
  EXPECT_NE(refusal(pulses, 2050us).find("leaves no low time"), std::string::npos);
  EXPECT_EQ(refusal(pulses, 2101us), "");
}

TEST(EscPulse, OneShotIsAnEighthAndMayBeFaster) {
  EscPulses pulses;
  pulses.protocol = EscProtocol::oneshot125;
  EXPECT_EQ(encode_pulse(1000us, pulses.protocol), 125us);
  EXPECT_EQ(encode_pulse(2000us, pulses.protocol), 250us);
  EXPECT_EQ(encode_pulse(1860us, pulses.protocol), 232500ns);
  EXPECT_EQ(refusal(pulses, 500us), "") << "2 kHz";
  EXPECT_EQ(refusal(pulses, 251us), "");
  EXPECT_NE(refusal(pulses, 250us), "") << "a pulse of 250 us leaves nothing of 250 us";
  EXPECT_NE(refusal(pulses, 200us), "");
}

TEST(EscPulse, RefusesLevelsThatAnEscWouldMisread) {
  const auto with = [](auto change) {
    EscPulses pulses;
    change(pulses);
    return refusal(pulses, 20ms);
  };
  EXPECT_NE(with([](EscPulses& p) { p.stop = 700us; }), "") << "thrown away";
  EXPECT_NE(with([](EscPulses& p) { p.high = 2500us; }), "") << "thrown away";
  EXPECT_NE(with([](EscPulses& p) { p.idle = 1470us; }).find("calibrate"), std::string::npos);
  EXPECT_NE(with([](EscPulses& p) { p.stop = 1100us; }), "") << "stop above idle";
  EXPECT_NE(with([](EscPulses& p) { p.full = 1060us; }), "") << "no travel";
}

TEST(EscPulse, ThrottleRunsFromIdleToFull) {
  const EscPulses pulses;
  EXPECT_EQ(pulse_of(0.0, pulses), 1060us);
  EXPECT_EQ(pulse_of(0.5, pulses), 1460us);
  EXPECT_EQ(pulse_of(1.0, pulses), 1860us);
  EXPECT_EQ(pulse_of(7.0, pulses), 1860us);
  EXPECT_EQ(pulse_of(-7.0, pulses), 1060us);
  EXPECT_EQ(pulse_of(std::nan(""), pulses), 1000us) << "no number: stop";
}

TEST(MotorAuthority, IsHeldByOneAtATime) {
  MotorBay bay;
  {
    auto autopilot = bay.claim("autopilot");
    ASSERT_TRUE(autopilot);
    const auto bench = bay.claim("ESC bench");
    ASSERT_FALSE(bench);
    EXPECT_EQ(bench.error().code, hal::ErrorCode::busy);
    EXPECT_NE(hal::describe(bench.error()).find("autopilot"), std::string::npos);
    const MotorAuthority moved = std::move(*autopilot);
    EXPECT_TRUE(moved.valid());
    EXPECT_FALSE(bay.claim("ESC bench")) << "moving is not giving back";
  }
  EXPECT_EQ(bay.holder(), "");
  EXPECT_TRUE(bay.claim("ESC bench"));
}

TEST(MotorAuthority, CannotBeCopiedOrMadeUp) {
  static_assert(!std::is_copy_constructible_v<MotorAuthority>);
  static_assert(!std::is_copy_assignable_v<MotorAuthority>);
  static_assert(!std::is_default_constructible_v<MotorAuthority>);
  static_assert(!std::is_default_constructible_v<PropsOff>);
}

TEST(PropsOff, WantsTheSentenceToTheLetter) {
  EXPECT_TRUE(PropsOff::confirm("the propellers are off"));
  for (const char* said : {"", "yes", "The propellers are off", "the propellers are off "}) {
    const auto refused = PropsOff::confirm(said);
    ASSERT_FALSE(refused) << said;
    EXPECT_NE(hal::describe(refused.error()).find("the propellers are off"), std::string::npos);
  }
}

}  // namespace
}  // namespace forager::flight
