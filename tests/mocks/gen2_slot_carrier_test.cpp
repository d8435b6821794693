// A slot-level field over its carrier's rhythm: flags, targets, drops of power, duty cycle.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mocks/detection.hpp"
#include "tests/mocks/slot_field_fixture.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

TEST_F(SlotTagFieldTest, S0IsForgottenAtEachDropOfTheCarrierOthersAreNot) {
  bare_physics();
  air.t0_s = 1e-3;
  air.patience_median_s = air.max_dwell_s = 5.0;  // one visit
  air.patience_log_sigma = 0.0;
  tags_at({0.5, 0.0, 0.0}, 5);
  EXPECT_EQ(fresh(5.0).size(), 5U) << "no drop";
  slots.hop_interval_s = 0.5;
  const auto hopping = fresh(5.0);
  EXPECT_GE(statistics.hops, 8U);
  EXPECT_LE(statistics.hops, 9U);
  EXPECT_EQ(hopping.size(), 5U * (statistics.hops + 1));
  std::map<std::uint32_t, int> channels;
  for (std::size_t i = 1; i < hopping.size(); ++i) {
    ++channels[hopping[i].frequency_khz];
    if (i % 5 == 0) {
      EXPECT_NE(hopping[i].frequency_khz, hopping[i - 1].frequency_khz);
    }
  }
  EXPECT_GE(channels.size(), 3U);
  settings.session = 2;
  EXPECT_EQ(fresh(5.0).size(), 5U);
  settings.session = 1;
  air.s1_persistence_min_s = air.s1_persistence_max_s = 2.0;
  EXPECT_EQ(fresh(5.0).size(), 15U) << "at 0, 2 and 4 s, hops or not";
}

TEST_F(SlotTagFieldTest, ACarrierThatGoesOffBeforeTheNextCommandLeavesTheTagUncounted) {
  bare_physics();
  air.t0_s = 1e-4;
  settings.session = 2;
  settings.on_time = 60ms;
  settings.off_time = 200ms;
  tags_at({0.5, 0.0, 0.0}, 100);
  // The carrier goes off in mid-round 30 times and more in each run. A read so late that the command behind
  // it (a Query at most) no longer fits has turned no flag: the tag answers again, which in S2 it would not.
  const double command_s = 1e-6 * slot_times(slots.link, 2).query_us;
  int again = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    std::map<std::uint32_t, double> read_s;
    for (const AirRead& r : fresh(10.0, 0.1, seed)) {
      const auto before = read_s.find(r.tag);
      if (before != read_s.end()) {
        ++again;
        EXPECT_GT(std::fmod(before->second, 0.26) + command_s, 0.06) << before->second;
      }
      read_s[r.tag] = hal::to_seconds(r.at);
    }
    EXPECT_EQ(read_s.size(), 100U);
  }
  EXPECT_GT(again, 5);
}

TEST_F(SlotTagFieldTest, TheDutyCycleAndTheDwellsAreKept) {
  four_ports();
  tags_in_view(100);
  settings.on_time = 100ms;
  settings.off_time = 200ms;
  for (const AirRead& r : fresh(30.0)) EXPECT_LE(std::fmod(hal::to_seconds(r.at), 0.3), 0.1 + 1e-9);
  world.tags = {};
  tags_at({1.2, 0.0, 0.0}, 50);
  // A fixed dwell: the forward port hears 0.25 s of each second.
  settings.on_time = settings.off_time = 0ms;
  air.max_dwell_s = air.patience_median_s = 0.25;
  air.patience_log_sigma = 0.0;
  for (const AirRead& r : fresh(30.0)) {
    EXPECT_EQ(r.port, 1);
    EXPECT_LE(std::fmod(hal::to_seconds(r.at), 1.0), 0.25 + 1e-9);
  }
}

TEST_F(SlotTagFieldTest, TargetsAskOneFlagOrBothInTurn) {
  bare_physics();
  settings.session = 2;
  tags_at({1.0, 0.0, 0.0}, 20);
  SlotTagField f = field();
  settings.target = 'B';
  EXPECT_TRUE(listen(f, 20.0).empty()) << "all are A";
  settings.target = 'A';
  EXPECT_EQ(listen(f, 60.0).size(), 20U);
  EXPECT_TRUE(listen(f, 20.0).empty());
  settings.target = 'B';
  EXPECT_EQ(listen(f, 60.0).size(), 20U) << "and back to A";
  settings.target = '*';
  const auto reads = listen(f, 60.0);
  const double rate = expected_answers(0.5);
  // A Poisson count of 20 tags that always answer; the time of 20 x 4.6 ms a second less.
  const double expected = 60.0 * 20.0 * rate / (1.0 + 20.0 * rate * 0.0046);
  EXPECT_NEAR(static_cast<double>(reads.size()), expected, 4.0 * std::sqrt(expected) + 0.03 * expected);
}

TEST_F(SlotTagFieldTest, S2TagsAnswerAgainAfterAnAbsenceLongerThanTheirTimer) {
  bare_physics();
  settings.session = 2;
  tags_at({1.0, 0.0, 0.0}, 50);
  SlotTagField f = field();
  EXPECT_EQ(listen(f, 60.0).size(), 50U);
  drive = [this](double t) { body.body.pose.position.x = t > 10.0 && t < 11.5 ? -30.0 : 0.0; };
  EXPECT_EQ(listen(f, 60.0).size(), 0U) << "1.5 s: no timer is shorter than 2 s";
  drive = [this](double t) { body.body.pose.position.x = t > 10.0 && t < 35.0 ? -30.0 : 0.0; };
  EXPECT_EQ(listen(f, 60.0).size(), 50U) << "25 s: none is longer than 20 s";
  drive = nullptr;
  f.radio_off(now);
  now += 30s;
  EXPECT_EQ(listen(f, 60.0).size(), 50U);
}

TEST_F(SlotTagFieldTest, NothingIsHeardBehindBeyondThePowerUpLimitOrWithTheRadioOff) {
  bare_physics();
  settings.target = '*';
  tags_at({-0.5, 0.0, 0.0}, 20);
  tags_at({4.01, 0.0, 0.0}, 20);
  SlotTagField f = field();
  EXPECT_TRUE(listen(f, 50.0).empty());
  body.body.pose.yaw_rad = hal::kPi;
  EXPECT_EQ(unique(listen(f, 50.0)), 20U);
  f.radio_off(now);
  std::vector<AirRead> reads;
  now += 10s;
  f.advance(now, reads);
  EXPECT_TRUE(reads.empty());
  settings.ports = {{9, 30.0, -80.0}};
  EXPECT_TRUE(listen(f, 5.0).empty()) << "no antenna there";
  settings.ports.clear();
  EXPECT_TRUE(listen(f, 5.0).empty());
}

}  // namespace
}  // namespace forager::mocks
