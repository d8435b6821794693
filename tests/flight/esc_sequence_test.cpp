// Pulse by pulse against what is known of SimonK ESCs: more than 10 stop pulses, low before power and for 2 s
// (so 11 and more: 0.22 s at 50 Hz, 27.5 ms at 400 Hz), calibration from 1460 us on, learnt values 17/16 and
// 31/32, silence of 131 ms.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "hal/random.hpp"
#include "tests/flight/esc_rig.hpp"

namespace forager::flight {
namespace {

using namespace std::chrono_literals;
using mocks::SimEscState;

struct Line {
  double at_s;
  std::string source;
  std::string text;
};

// Entries of the journal, "1.220000000 sim motor 1 pulse 1000.0 us" taken apart.
std::vector<Line> lines_of(const mocks::TextJournal& journal, const std::string& source) {
  std::vector<Line> lines;
  std::istringstream all(journal.text());
  for (std::string line; std::getline(all, line);) {
    const auto blank = line.find(' ');
    const std::string rest = line.substr(blank + 1);
    if (rest.rfind(source + " ", 0) != 0) continue;
    lines.push_back({std::stod(line.substr(0, blank)), source, rest.substr(source.size() + 1)});
  }
  return lines;
}

double pulse_us(const std::string& text) { return std::stod(text.substr(std::string("pulse ").size())); }

class EscSequence : public ::testing::TestWithParam<hal::Duration> {};

TEST_P(EscSequence, ArmsIdlesAndRampsPulseByPulse) {
  const double period_s = hal::to_seconds(GetParam());
  EscRig rig({.period = GetParam(), .note_pulses = true});
  rig.arm();
  rig.fly(0.0, 200ms);
  rig.fly(0.5, 2s);
  rig.bank().halt();
  rig.run(100ms);

  const auto own = lines_of(rig.journal(), "esc");
  const auto heard = lines_of(rig.journal(), "sim motor 1");
  const auto when = [&](const std::vector<Line>& in, const std::string& text) {
    const auto found =
        std::find_if(in.begin(), in.end(), [&](const Line& l) { return l.text.rfind(text, 0) == 0; });
    EXPECT_NE(found, in.end()) << text;
    return found == in.end() ? -1.0 : found->at_s;
  };
  const double first_low = when(own, "motor 1 1000.0 us");
  const double power = when(own, "power on");
  const double esc_armed = when(heard, "armed");
  const double idle = when(own, "motor 1 1060.0 us");
  EXPECT_GE(power - first_low, 11 * period_s - 1e-9) << "low before power";
  EXPECT_GE(idle - power, 2.0 - 1e-9) << "low for two seconds";
  EXPECT_LT(esc_armed, idle) << "the ESC is ready before anything but stop is sent";

  int low_before_armed = 0;
  double before = 0.0;
  double last_at = 0.0;
  for (const Line& line : heard) {
    if (line.text.rfind("pulse", 0) != 0) continue;
    const double us = pulse_us(line.text);
    if (last_at > 0.0) {
      EXPECT_NEAR(line.at_s - last_at, period_s, 1e-8) << "a steady stream, no gap";
    }
    last_at = line.at_s;
    if (line.at_s <= esc_armed) {
      EXPECT_EQ(us, 1000.0);
      ++low_before_armed;
    } else if (line.at_s <= idle) {
      EXPECT_EQ(us, 1000.0) << "still stop";
    } else if (us > 1000.0) {
      EXPECT_GE(us, std::max(before, 1060.0)) << "the ramp only rises";
      EXPECT_LE(us - std::max(before, 1060.0), 0.5 * 800.0 * (period_s + 0.006)) << "and not faster";
      EXPECT_LE(us, 1460.0);
    }
    before = us;
  }
  EXPECT_EQ(low_before_armed, 11) << "it armed at the eleventh stop pulse";
  EXPECT_EQ(before, 1000.0) << "halt: stop again";
  EXPECT_EQ(rig.esc().calibrations_begun(), 0U);
}

TEST_P(EscSequence, CalibratesPulseByPulse) {
  const double period_s = hal::to_seconds(GetParam());
  EscRig rig({.period = GetParam(), .note_pulses = true});
  ASSERT_TRUE(rig.bank().calibrate(EscRig::word(), rig.now()));
  for (int i = 0; i < 4000 && rig.bank().state() == EscState::calibrating; ++i) rig.step();
  ASSERT_EQ(rig.bank().state(), EscState::stopped);

  EXPECT_EQ(rig.esc().calibrations_done(), 1U);
  const EscLearned learned = learned_from(EscPulses{});
  EXPECT_EQ(rig.esc().stop_pulse(), learned.stop);
  EXPECT_EQ(rig.esc().full_pulse(), learned.full);
  EXPECT_EQ(learned.stop, 1062500ns);
  EXPECT_EQ(learned.full, 1937500ns);

  int high = 0;
  int low = 0;
  for (const Line& line : lines_of(rig.journal(), "sim motor 1")) {
    if (line.text.rfind("pulse", 0) != 0) continue;
    const double us = pulse_us(line.text);
    EXPECT_TRUE(us == 2000.0 || us == 1000.0) << us;
    EXPECT_TRUE(us == 1000.0 || low == 0) << "never high again";
    (us == 2000.0 ? high : low) += 1;
  }
  EXPECT_GE(high * period_s, 1.3) << "2 s less the beeps";
  EXPECT_GE(high, 32);
  EXPECT_GE(low, 32);
  EXPECT_FALSE(rig.power().active()) << "ends without power";
  EXPECT_EQ(rig.esc().most_spin(), 0.0) << "the motor never turned";
}

INSTANTIATE_TEST_SUITE_P(Rates, EscSequence, ::testing::Values(20ms, 10ms, 2500us),
                         [](const auto& rate) { return std::to_string(rate.param.count()) + "ns"; });

TEST(EscSafety, ABootWithThrottleHighReachesNoCalibration) {
  // Without this layer: a line that is high when the ESC wakes is taken for a calibration.
  mocks::SimEsc naive("naive", {});
  hal::Instant now{1s};
  naive.set_power(true, now);
  naive.update(now += 600ms);
  for (int i = 0; i < 40; ++i) naive.pulse(1860us, now += 20ms);
  ASSERT_EQ(naive.calibrations_begun(), 1U);

  // With it: the owner shouts full throttle from the first moment on, in every state.
  for (const bool switched : {true, false}) {
    EscRig rig({.switched = switched});
    for (int i = 0; i < 200; ++i) rig.fly(1.0, 5ms);
    if (!switched) rig.set_power(true);  // a person plugs the battery in now
    ASSERT_TRUE(rig.bank().arm(EscRig::word(), rig.now()));
    rig.fly(1.0, 6s);
    EXPECT_EQ(rig.esc().calibrations_begun(), 0U);
    EXPECT_EQ(rig.esc().armings(), 1U);
  }
}

TEST(EscSafety, AnEscThatWakesLateIsNotCalibratedWithinTheDefaultLimit) {
  // The person plugs the battery in long after the program thinks that motors turn. It cannot know.
  EscRig::Options options{.switched = false};
  options.config = EscBankConfig{};
  EscRig rig(options);
  rig.arm();
  rig.fly(1.0, 3s);
  rig.set_power(true);
  rig.fly(1.0, 3s);
  EXPECT_EQ(rig.esc().calibrations_begun(), 0U);
  EXPECT_EQ(rig.esc().most_spin(), 0.0);
}

TEST(EscSafety, CalibrationAbortedAnywhereLeavesStop) {
  for (const auto after : {10ms, 2500ms, 3100ms, 4200ms, 5100ms, 6500ms}) {
    EscRig rig({});
    ASSERT_TRUE(rig.bank().calibrate(EscRig::word(), rig.now()));
    rig.run(after);
    rig.bank().halt();
    rig.run(3s);
    EXPECT_EQ(rig.line(), 1000us);
    EXPECT_FALSE(rig.power().active());
    EXPECT_EQ(rig.esc().most_spin(), 0.0);
  }
}

TEST(EscSafety, CalibrationWaitsForTheBatteryWithoutASwitch) {
  EscRig rig({.switched = false});
  ASSERT_TRUE(rig.bank().calibrate(EscRig::word(), rig.now()));
  rig.run(6s);
  EXPECT_TRUE(rig.bank().line_high());
  rig.set_power(true);
  for (int i = 0; i < 6000 && rig.bank().state() == EscState::calibrating; ++i) rig.step();
  EXPECT_EQ(rig.esc().calibrations_done(), 1U);
}

// Whatever is asked in whatever order, with whatever goes wrong: no pulse above idle reaches an ESC that has
// not armed, none above the calibration level ever, and only calibrate() makes a calibration.
RC_GTEST_PROP(EscSafety, NoPulseAboveIdleBeforeArmed, (std::uint64_t seed)) {
  hal::Random random(seed);
  const bool switched = random.chance(0.5);
  EscRig rig({.period = random.chance(0.5) ? 20000us : 2500us, .motors = 2, .switched = switched});
  if (!switched && random.chance(0.5)) rig.set_power(true);
  for (int i = 0; i < 60; ++i) {
    const double throttle = random.uniform(-0.2, 1.2);
    switch (random.below(10)) {
      case 0:
        (void)rig.bank().arm(EscRig::word(), rig.now());
        break;
      case 1:
        rig.bank().disarm("asked", rig.now());
        break;
      case 2:
        rig.bank().halt();
        break;
      case 3:
        (void)rig.bank().resume(rig.now());
        break;
      case 4:
        (void)rig.bank().clear_fault(rig.now());
        break;
      case 5:
        rig.channel(random.below(2)).fail_next({hal::ErrorCode::io, "bus", "write", "noise", "", 0});
        break;
      case 6:
        rig.live(hal::from_seconds(random.uniform(0.0, 0.4)));
        break;
      default:
        break;
    }
    const hal::Instant end = rig.now() + hal::from_seconds(random.uniform(0.0, 1.0));
    while (rig.now() < end) {
      (void)rig.bank().command(std::vector<double>(2, throttle), rig.now());
      rig.step(10ms);
      for (std::size_t m = 0; m < 2; ++m) {
        if (rig.bank().state() != EscState::armed && rig.bank().state() != EscState::faulted) {
          RC_ASSERT(rig.line(m) <= 1060us);
          RC_ASSERT(!switched || rig.esc(m).drive() == 0.0);
        }
        RC_ASSERT(rig.line(m) >= 1000us && rig.line(m) <= 1860us);
        RC_ASSERT(rig.esc(m).calibrations_begun() == 0U);
      }
    }
  }
}

}  // namespace
}  // namespace forager::flight
