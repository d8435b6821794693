#include "servo/pulse_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace forager::servo {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PulseMap brake_map() { return PulseMap::between({0.0, 1180us}, {1.0, 1725us}).value(); }

TEST(PulseMap, GivesTheCalibratedPulsesExactlyAndLinesBetween) {
  const PulseMap map = PulseMap::create({{-0.5, 900us}, {0.0, 1500us}, {1.0, 1900us}}).value();
  EXPECT_EQ(900us, map.pulse(-0.5).value());
  EXPECT_EQ(1200us, map.pulse(-0.25).value());
  EXPECT_EQ(1500us, map.pulse(0.0).value());
  EXPECT_EQ(1700us, map.pulse(0.5).value());
  EXPECT_EQ(1900us, map.pulse(1.0).value());
}

TEST(PulseMap, ClampsWhatLiesBeyondItsEndsAndRefusesWhatIsNoNumber) {
  const PulseMap map = brake_map();
  for (const double low : {-1e-9, -1.0, -1e300, -kInfinity}) EXPECT_EQ(1180us, map.pulse(low).value());
  for (const double high : {1.0000001, 1e300, kInfinity}) EXPECT_EQ(1725us, map.pulse(high).value());
  EXPECT_EQ(hal::ErrorCode::invalid_argument, map.pulse(kNan).error().code);
}

TEST(PulseMap, RefusesTablesThatAreNoMap) {
  const auto why = [](std::vector<PulsePoint> points) {
    const auto map = PulseMap::create(std::move(points));
    return map ? std::string("accepted") : map.error().detail;
  };
  EXPECT_THAT(why({}), HasSubstr("fewer than two"));
  EXPECT_THAT(why({{0.0, 1ms}}), HasSubstr("fewer than two"));
  EXPECT_THAT(why({{0.0, 1ms}, {0.0, 2ms}}), HasSubstr("0 after 0"));
  EXPECT_THAT(why({{1.0, 1ms}, {0.0, 2ms}}), HasSubstr("0 after 1"));
  EXPECT_THAT(why({{0.0, 1ms}, {kNan, 2ms}}), HasSubstr("not a finite number"));
  EXPECT_THAT(why({{-1e308, 1ms}, {1.7e308, 2ms}}), HasSubstr("after"));  // their distance overflows
  EXPECT_THAT(why({{0.0, 1ms}, {1.0, 1ms}}), HasSubstr("1000000 ns after"));
  EXPECT_THAT(why({{0.0, 1ms}, {1.0, 2ms}, {2.0, 1500us}}), HasSubstr("1500000 ns after"));
  EXPECT_THAT(why({{0.0, 0ms}, {1.0, 2ms}}), HasSubstr("a pulse of 0 ns"));
  EXPECT_THAT(why({{0.0, 1ms}, {1.0, 2s}}), HasSubstr("a pulse of 2000000000 ns"));
}

TEST(PulseMap, ASecondLongPulseOverAHugeRangeDoesNotOverflow) {
  const PulseMap map = PulseMap::between({-1e15, 1us}, {1e15, 1s}).value();
  EXPECT_EQ(hal::Duration(500'000'500), map.pulse(0.0).value());
  EXPECT_EQ(hal::Duration(750'000'250), map.pulse(0.5e15).value());
}

RC_GTEST_PROP(PulseMap, IsMonotonicAndItsInverseLeadsBackToTheSamePulse, ()) {
  const bool rising = *rc::gen::arbitrary<bool>();
  const int from_us = *rc::gen::inRange(500, 1500);
  const int by_us = *rc::gen::inRange(1, 1000);
  const int middle_us = *rc::gen::inRange(1, 1000);
  const auto us = [](int n) { return hal::Duration(std::chrono::microseconds(n)); };
  std::vector<PulsePoint> points{
      {0.0, us(from_us)}, {0.4, us(from_us + by_us)}, {1.0, us(from_us + by_us + middle_us)}};
  if (!rising) {
    std::swap(points[0].pulse, points[2].pulse);
  }
  const PulseMap map = PulseMap::create(points).value();
  const double a = *rc::gen::inRange(-100, 1100) / 1000.0;
  const double b = a + *rc::gen::inRange(0, 1000) / 1e6;
  const auto pulse_a = map.pulse(a).value();
  const auto pulse_b = map.pulse(b).value();
  RC_ASSERT((rising ? pulse_a <= pulse_b : pulse_a >= pulse_b));
  RC_ASSERT(map.pulse(map.at(pulse_a)).value() == pulse_a);
  RC_ASSERT(std::abs(map.at(pulse_a) - std::min(1.0, std::max(0.0, a))) < 1e-3);
}

}  // namespace
}  // namespace forager::servo
