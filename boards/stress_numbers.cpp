// Random numbers, sums, counters and time.
#include <algorithm>
#include <cmath>
#include <limits>

#include "boards/running_moments.hpp"
#include "boards/stress_case.hpp"
#include "flight/pose_history.hpp"
#include "flight/vision_filter.hpp"
#include "hal/random.hpp"
#include "hal/time.hpp"
#include "hal/units.hpp"
#include "mocks/gen2_field_flags.hpp"
#include "mocks/gen2_q.hpp"
#include "reader/clock_offset.hpp"
#include "servo/motion_estimate.hpp"

namespace forager::boards {
namespace {

using namespace std::chrono_literals;
using hal::Instant;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A 24 bit uniform rounds to 1 and to 0 now and then: 3e-8 of the certain tags missed, 6e-8 of the dead ones
// read.
StressCase uniforms() {
  Worst worst;
  hal::Random random(1);
  for (int i = 0; i < 1'000'000; ++i) {
    const double u = random.uniform();
    // A multiple of 2^-53 in [0, 1).
    worst.must(u >= 0.0 && u <= 1.0 - 0x1p-53 && std::ldexp(u, 53) == std::floor(std::ldexp(u, 53)));
    worst.must(random.chance(1.0) && !random.chance(0.0));
    const double wait = random.exponential();
    worst.must(wait >= 0.0 && wait <= 53.0 * std::log(2.0));
    worst.must(std::isfinite(random.normal()));
  }
  return worst.against("random: uniforms within [0, 1), PD 1 always and PD 0 never drawn", 0.0);
}

StressCase moments_of_large_numbers() {
  Worst worst;
  hal::Random random(2);
  RunningMoments all, even, odd;
  // A million numbers that are 1e6 and a little: their squares differ in the last digits only.
  double centred = 0.0;
  double centred_squares = 0.0;
  for (int i = 0; i < 1'000'000; ++i) {
    const double u = random.uniform() - 0.5;
    const double value = 1e6 + u;
    const double kept = value - 1e6;
    centred += kept;
    centred_squares += kept * kept;
    all.add(value);
    (i % 2 == 0 ? even : odd).add(value);
  }
  const double n = 1e6;
  const double mean = centred / n;
  const double variance = (centred_squares - n * mean * mean) / (n - 1.0);
  even.merge(odd);
  for (const RunningMoments& m : {all, even}) {
    worst.add(std::abs((m.mean() - 1e6) - mean));
    worst.relative(m.variance(), variance);
  }
  return worst.against("moments: mean and variance of 1e6 numbers near 1e6, merged and not", 1e-7);
}

StressCase an_hour_of_milliseconds() {
  Worst worst;
  Instant now{};
  for (int i = 0; i < 3'600'000; ++i) now += 1ms;
  worst.near(hal::to_seconds(now), 3600.0);
  // A year on, a nanosecond still counts.
  const Instant later = now + std::chrono::hours(24 * 365);
  worst.must(later + 1ns > later && (later + 1ns) - later == 1ns);
  return worst.against("time: an hour in steps of 1 ms, seconds off", 0.0);
}

StressCase seconds_that_are_none() {
  Worst worst;
  worst.must(hal::from_seconds(kNaN) == 0ns);
  worst.must(hal::from_seconds(kInf) == hal::Duration::max());
  worst.must(hal::from_seconds(-kInf) == hal::Duration::min());
  worst.must(hal::from_seconds(1e300) == hal::Duration::max());
  worst.must(hal::from_seconds(-0.0) == 0ns && hal::from_seconds(5e-324) == 0ns);
  worst.must(hal::from_seconds(1e-9) == 1ns && hal::from_seconds(-1.5e-9) == -2ns);
  return worst.against("time: NaN, infinite, huge and tiny seconds", 0.0);
}

// The reader's clock: years off, set by an hour, slewed by 500 ppm; replies stamped out of order.
StressCase two_clocks() {
  Worst worst;
  constexpr std::int64_t kYears = 1'250'000'000'000;
  reader::ClockOffset offset;
  Instant now{};
  const auto at_reader = [&](Instant t, std::int64_t set_ms, double rate) {
    return kYears + set_ms + static_cast<std::int64_t>(std::llround(rate * hal::to_seconds(t) * 1e3));
  };
  for (int i = 0; i < 600; ++i, now += 1s) offset.add(now - 4ms, now + 4ms, at_reader(now, 0, 1.0 + 500e-6));
  worst.must(offset.steps() == 0);
  // Slewed: as true as its own bound says.
  const auto slewed = offset.to_instant(at_reader(now, 0, 1.0 + 500e-6), Instant{});
  worst.add(std::abs(hal::to_seconds(slewed - now)) / hal::to_seconds(offset.uncertainty(now)));
  for (const std::int64_t step_ms : {3'600'000, -3'600'000, 0}) {
    const std::uint32_t before = offset.steps();
    now += 1s;
    offset.add(now - 4ms, now + 4ms, at_reader(now, step_ms, 1.0));
    worst.must(offset.steps() == before + 1);
    worst.add(std::abs(hal::to_seconds(offset.to_instant(at_reader(now, step_ms, 1.0), Instant{}) - now)) /
              hal::to_seconds(offset.uncertainty(now)));
  }
  return worst.against("time: reader clock years off, stepped +-1 h, slewed 500 ppm: error over its bound",
                       1.0);
}

// dt of 0, below 0, 1 ns, 10 s and an hour; and numbers that are none.
StressCase jumps_of_time() {
  Worst worst;
  servo::MotionEstimate estimate({});
  flight::VisionFilter filter({});
  flight::PoseHistory history;
  const hal::Pose here{{1.0, 2.0, 0.5}, 3.1, 0.0, 0.0};
  Instant now = Instant{} + 1h;
  estimate.take({now, here, hal::PoseConfidence::high, 0});
  std::uint64_t passed = 0;
  for (const hal::Duration step :
       {hal::Duration(33ms), hal::Duration(0), hal::Duration(1ns), hal::Duration(-33ms), hal::Duration(10s),
        hal::Duration(-1h), hal::Duration(1h)}) {
    now += step;
    const hal::PoseSample sample{now, here, hal::PoseConfidence::high, 0};
    if (filter.update(sample, now)) ++passed;
    history.add(now, here);
    estimate.predict(now, 0.0, 0.0);
    estimate.take(sample);
    worst.add(hal::norm(estimate.pose().position - here.position));
    worst.add(std::abs(hal::angle_difference(estimate.pose().yaw_rad, here.yaw_rad)));
    const auto then = history.at(now, 1s);
    if (then) worst.add(hal::norm(then->position - here.position));
  }
  // Of two samples of one stamp, or an older one, the second is no news: 33 ms, 10 s and one hour pass.
  worst.must(passed >= 2 && passed <= 4);
  worst.must(
      !filter.update({now + 1s, {{kNaN, 0.0, 0.0}, 0.0, 0.0, 0.0}, hal::PoseConfidence::high, 0}, now + 1s));
  worst.must(!estimate.take({now + 1s, {{kInf, 0.0, 0.0}, 0.0, 0.0, 0.0}, hal::PoseConfidence::high, 0}));
  worst.must(hal::is_finite(filter.newest()->pose.position));
  return worst.against("time: poses 0 s, 1 ns, 10 s, 1 h apart, backwards, NaN: metres and radians off",
                       1e-9);
}

// Gen2 table 6.14: a flag is gone at the very instant its timer ends, and not before.
StressCase session_expiry() {
  Worst worst;
  const mocks::AirParameters air;
  for (const double start : {0.0, 1.0, 1e6, 1e9}) {
    mocks::SessionFlags flags(64, air, 9);
    for (std::uint32_t tag = 0; tag < 64; ++tag) {
      flags.set(tag, 1, true, start, 1);
      const double end = start + flags.s1_persistence_s(tag);
      worst.must(flags.is_b(tag, 1, std::nextafter(end, 0.0), 1));
      worst.must(!flags.is_b(tag, 1, end, 1));
      flags.set(tag, 2, true, start, 1);
      flags.set_power(tag, false, start);
      const double gone = start + flags.s2_persistence_s(tag);
      // The sum that gives the instant rounds, and so does the difference that is asked.
      const double ulp = std::nextafter(gone, HUGE_VAL) - gone;
      worst.must(flags.is_b(tag, 2, gone - 2.0 * ulp, 1));
      worst.must(!flags.is_b(tag, 2, gone + 2.0 * ulp, 1));
    }
  }
  return worst.against("gen2: S1 and S2 flags at the instant of expiry, to 1e9 s", 0.0);
}

StressCase q_at_its_clamp() {
  Worst worst;
  for (const double step : {0.1, 0.3, 0.5, 1.0}) {
    mocks::QAlgorithm q(4.0, step);
    for (int i = 0; i < 1'000'000; ++i) q.empty();
    worst.must(q.q() == 0 && q.floating() == 0.0);
    for (int i = 0; i < 1'000'000; ++i) q.collided();
    worst.must(q.q() == 15 && q.floating() == 15.0);
    q.empty();
    worst.near(q.floating(), 15.0 - step);
  }
  return worst.against("gen2: floating Q after a million steps against its ends", 0.0);
}

}  // namespace

std::vector<StressCase> stress_numbers() {
  return {uniforms(),
          moments_of_large_numbers(),
          an_hour_of_milliseconds(),
          seconds_that_are_none(),
          two_clocks(),
          jumps_of_time(),
          session_expiry(),
          q_at_its_clamp()};
}

}  // namespace forager::boards
