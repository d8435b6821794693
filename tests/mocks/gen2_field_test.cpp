// Who answers, and how often: the detection model as the round-level field draws it.
#include "mocks/gen2_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/mocks/round_field_fixture.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;
using hal::Instant;
using hal::Vec3;

TEST_F(SimTagFieldTest, HalfOfTheTagsAtR0AnswerWithinT0) {
  bare_physics();
  settings_.session = 2;
  tags_at({2.0, 0.0, 0.0}, 4000);
  const auto reads = listen(10.0);
  const auto until = [&](double t) {
    return std::count_if(reads.begin(), reads.end(),
                         [t](const AirRead& r) { return hal::to_seconds(r.at) <= t; });
  };
  // Binomial deviation 32 of 4000; four of them.
  EXPECT_NEAR(static_cast<double>(until(1.0)), 2000.0, 130.0);
  EXPECT_NEAR(static_cast<double>(until(2.0)), 3000.0, 110.0);
  EXPECT_NEAR(static_cast<double>(until(10.0)), 4000.0 * (1.0 - std::pow(0.5, 10.0)), 10.0);
}

TEST_F(SimTagFieldTest, ATagAnswersAtTheHazardRateOfItsPlace) {
  bare_physics();
  settings_.target = '*';
  const AntennaPattern pattern;
  for (const Vec3 place :
       {Vec3{1.0, 0.0, 0.0}, Vec3{1.5, 1.0, 0.0}, Vec3{2.0, -0.7, 0.5}, Vec3{0.5, 0.1, 0.2}}) {
    world_.tags.clear();
    tags_at(place, 1);
    const double rate = expected_answers(normalised_range(norm(place), 2.0, pattern.power(place)));
    const auto reads = listen(2000.0, 1.0);
    // A Poisson count; four deviations.
    EXPECT_NEAR(static_cast<double>(reads.size()), 2000.0 * rate, 4.0 * std::sqrt(2000.0 * rate)) << place.x;
  }
}

TEST_F(SimTagFieldTest, FourPortsShareOneRadio) {
  bare_physics();
  settings_.target = '*';
  tags_at({1.0, 0.0, 0.0}, 1);
  const auto alone = listen(2000.0, 1.0).size();
  four_antennas();
  for (auto& a : antennas_) a.position_body = {};
  for (auto& p : settings_.ports) p.sensitivity_dbm = -200.0;
  const auto shared = listen(2000.0, 1.0);
  // A quarter of the time; four deviations of a Poisson count.
  const double quarter = static_cast<double>(alone) / 4.0;
  EXPECT_NEAR(static_cast<double>(shared.size()), quarter, 4.0 * std::sqrt(quarter));
  for (const AirRead& r : shared) ASSERT_EQ(r.port, 4);
}

TEST_F(SimTagFieldTest, AtRestTheRepliesDoNotDependOnTheTick) {
  aisle();
  const auto fine = listen(10.0, 0.01);
  ASSERT_GT(fine.size(), 100U);
  for (const double tick : {0.1, 1.0}) {
    const auto coarse = listen(10.0, tick);
    ASSERT_EQ(coarse.size(), fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
      EXPECT_EQ(coarse[i].at, fine[i].at);
      EXPECT_EQ(coarse[i].tag, fine[i].tag);
      EXPECT_EQ(coarse[i].rssi_dbm, fine[i].rssi_dbm);
    }
  }
}

TEST_F(SimTagFieldTest, OnTheMoveTheTotalsDoNotDependOnTheTick) {
  aisle();
  drive_ = [this](double t) { body_.body.pose.position.x = 1.0 * t; };
  double totals[3] = {};
  const double ticks[3] = {0.01, 0.1, 1.0};
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    for (int i = 0; i < 3; ++i) {
      body_.body.pose.position.x = 0.0;
      totals[i] += static_cast<double>(unique(listen(10.0, ticks[i], seed)));
    }
  // 12 runs of about 300 tags each; runs of one seed share their tags, so they differ by some 10 tags each:
  // 35 in the sum. A detection per tick instead of per second would be off by factors.
  EXPECT_NEAR(totals[1], totals[0], 150.0);
  EXPECT_NEAR(totals[2], totals[0], 150.0);
}

TEST_F(SimTagFieldTest, NothingIsHeardBehindOrBeyondThePowerUpLimit) {
  bare_physics();
  settings_.target = '*';
  tags_at({-0.5, 0.0, 0.0}, 20);
  tags_at({0.0, 1.0, 0.0}, 20);
  tags_at({0.3, 0.0, 1.0}, 20);
  tags_at({4.01, 0.0, 0.0}, 20);
  EXPECT_EQ(listen(100.0, 1.0).size(), 0U);
  body_.body.pose.yaw_rad = hal::kPi;
  EXPECT_GT(unique(listen(100.0, 1.0)), 19U);
}

TEST_F(SimTagFieldTest, ReachFollowsTheForwardLink) {
  bare_physics();
  for (int i = 1; i <= 200; ++i) tags_at({0.05 * i, 0.0, 0.0}, 1);
  double farthest[2] = {};
  for (int i = 0; i < 2; ++i) {
    settings_.ports[0].power_dbm = i == 0 ? 24.0 : 30.0;
    for (const AirRead& r : listen(200.0, 1.0))
      farthest[i] = std::max(farthest[i], world_.tags[r.tag].position.x);
  }
  EXPECT_NEAR(farthest[1], 4.0, 0.051);  // power-up limit 2, R0 2 m
  EXPECT_NEAR(farthest[0], 4.0 * std::pow(10.0, -6.0 / 20.0), 0.051);
}

TEST_F(SimTagFieldTest, ObstaclesCostOnlyWhenAskedAndNotTheOwnShelf) {
  bare_physics();
  settings_.target = '*';
  tags_at({1.5, 0.0, 0.0}, 1);
  world_.obstacles.push_back({{0.8, -1.0, 0.0}, {0.9, 1.0, 3.0}});
  world_.obstacles.push_back({{1.4, -1.0, 0.0}, {1.6, 1.0, 3.0}});
  const auto open = listen(500.0, 1.0).size();
  air_.occlusion_db = 3.0;
  const auto dimmed = static_cast<double>(listen(500.0, 1.0).size());
  const double rate = expected_answers(1.5 / (2.0 * std::pow(10.0, -3.0 / 20.0)));
  EXPECT_NEAR(dimmed, 500.0 * rate, 4.0 * std::sqrt(500.0 * rate));
  EXPECT_GT(static_cast<double>(open), 1.2 * dimmed);
  air_.occlusion_db = 30.0;
  EXPECT_EQ(listen(500.0, 1.0).size(), 0U);
}

TEST_F(SimTagFieldTest, TheBoundItDrawsUnderHoldsOnAWildRide) {
  aisle();
  drive_ = [this](double t) {
    body_.body.pose.position = {7.0 + 6.0 * std::sin(0.3 * t), 0.6 * std::sin(1.1 * t),
                                1.2 + 0.5 * std::sin(0.7 * t)};
    body_.body.pose.yaw_rad = hal::wrap_pi(2.0 * t);
    body_.body.pose.roll_rad = 0.3 * std::sin(t);
  };
  SimTagField field(world_, body_, antennas_, air_, 4);
  EXPECT_GT(listen(field, 120.0).size(), 1000U);
  EXPECT_EQ(field.statistics().bound_exceeded, 0U);
}

TEST_F(SimTagFieldTest, TheCutOfHopelessTagsChangesNothingThatCouldBeSeen) {
  bare_physics();
  settings_.target = '*';
  air_.power_up_limit = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= 400; ++i) tags_at({0.15 * i, 0.0, 0.0}, 1);
  SimTagField cut(world_, body_, antennas_, air_, 1);
  const auto with_cut = static_cast<double>(listen(cut, 200.0, 1.0).size());
  air_.hazard_cut = 0.0;
  now_ = Instant{};
  SimTagField full(world_, body_, antennas_, air_, 2);
  const auto without = static_cast<double>(listen(full, 200.0, 1.0).size());
  EXPECT_NEAR(with_cut, without, 5.0 * std::sqrt(2.0 * without));
}

TEST_F(SimTagFieldTest, RadioOffIsSilence) {
  aisle();
  SimTagField field(world_, body_, antennas_, air_, 4);
  EXPECT_GT(listen(field, 5.0).size(), 20U);
  field.radio_off(now_);
  std::vector<AirRead> reads;
  field.advance(now_ + 10s, reads);
  EXPECT_TRUE(reads.empty());
  now_ += 10s;
  const auto again = listen(field, 5.0);
  EXPECT_GT(again.size(), 20U);
  EXPECT_GE(hal::to_seconds(again.front().at), 15.0);
  settings_.ports = {{9, 30.0, -80.0}};
  EXPECT_TRUE(listen(field, 5.0).empty()) << "no antenna hangs on port 9";
  settings_.ports.clear();
  EXPECT_TRUE(listen(field, 5.0).empty());
}

TEST_F(SimTagFieldTest, EqualSeedsGiveEqualReads) {
  aisle();
  const auto reads = [&](std::uint64_t seed) {
    std::vector<std::int64_t> at;
    for (const AirRead& r : listen(5.0, 0.02, seed)) at.push_back(r.at.time_since_epoch().count());
    return at;
  };
  EXPECT_EQ(reads(1), reads(1));
  EXPECT_NE(reads(1), reads(2));
}

TEST_F(SimTagFieldTest, RefusesNonsense) {
  four_antennas();
  EXPECT_TRUE(validate(air_, antennas_));
  air_.t0_s = 0.0;
  const auto zero = validate(air_, antennas_);
  ASSERT_FALSE(zero);
  EXPECT_NE(zero.error().detail.find("t0_s"), std::string::npos);
  air_.t0_s = std::nan("");
  EXPECT_FALSE(validate(air_, antennas_));
  air_.t0_s = 1.0;
  antennas_[1].port = antennas_[0].port;
  EXPECT_FALSE(validate(air_, antennas_));
}

}  // namespace
}  // namespace forager::mocks
