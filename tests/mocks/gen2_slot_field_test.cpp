// Reads of a slot-level field: how likely, how fast, in whose name.
#include "mocks/gen2_slot_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "mocks/detection.hpp"
#include "tests/mocks/slot_field_fixture.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::mocks {
namespace {

using namespace std::chrono_literals;

TEST_F(SlotTagFieldTest, ALoneTagIsReadWithinT0WithItsProbabilityAtAnyTick) {
  bare_physics();
  settings.session = 2;
  for (const double u : {0.1, 0.5, 1.0, 1.8}) {
    world.tags = {};
    tags_at({2.0 * u, 0.0, 0.0}, 1);
    const double pd = detection_probability(u);
    for (const double tick : {0.01, 0.1, 1.0}) {
      // Four deviations of a binomial count, and the delay of a read, 10 ms at this hazard rate.
      const int runs = tick == 0.1 ? 4000 : 1000;
      const double delay = (1.0 - pd) * expected_answers(u) * 0.010;
      EXPECT_NEAR(heard_within_t0(runs, tick), pd, 4.0 * std::sqrt(pd * (1.0 - pd) / runs) + delay)
          << "u " << u << " tick " << tick;
    }
  }
}

TEST_F(SlotTagFieldTest, RepliesLostOnTheWayBackCostTimeButNotThePd) {
  bare_physics();
  settings.session = 2;
  tags_at({2.0, 0.0, 0.0}, 1);
  // At 2 m the reply has -53 - 12 dBm: half of the replies are lost.
  slots.decode_half_dbm = -53.0 - 40.0 * std::log10(2.0);
  for (const bool nak : {true, false}) {
    slots.nak_bad_replies = nak;
    std::uint64_t lost = 0;
    std::uint64_t read = 0;
    int heard = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
      heard += fresh(1.0, 0.1, seed).empty() ? 0 : 1;
      lost += statistics.lost;
      read += statistics.single;
    }
    if (nak) {
      EXPECT_NEAR(heard / 4000.0, 0.5, 0.04);
      // Unread tags lose hazard T0 = ln 2 replies each, less what the read ones spare.
      EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(read), 1.0, 0.12);
    } else {
      EXPECT_LT(heard / 4000.0, 0.42) << "tags that turn their flag unread are lost to the session";
    }
  }
}

TEST_F(SlotTagFieldTest, AtRestTheReadsDoNotDependOnTheTick) {
  four_ports();
  tags_in_view(200);
  const auto fine = fresh(5.0, 0.01);
  ASSERT_GT(fine.size(), 100U);
  for (const double tick : {0.1, 1.0}) {
    const auto coarse = fresh(5.0, tick);
    ASSERT_EQ(coarse.size(), fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
      EXPECT_EQ(coarse[i].at, fine[i].at);
      EXPECT_EQ(coarse[i].tag, fine[i].tag);
      EXPECT_EQ(coarse[i].rssi_dbm, fine[i].rssi_dbm);
    }
  }
}

TEST_F(SlotTagFieldTest, OnTheMoveTheTotalsDoNotDependOnTheTick) {
  four_ports();
  for (int i = 0; i < 40; ++i) tags_at({0.3 * i, 1.5, 0.0}, 8);
  drive = [this](double t) { body.body.pose.position.x = t; };
  std::map<double, double> total;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (const double tick : {0.01, 0.1, 1.0}) {
      body.body.pose.position.x = 0.0;
      total[tick] += static_cast<double>(unique(fresh(10.0, tick, seed)));
    }
  // Some 100 of 320 tags in each of ten runs: a deviation of 30 in the sum.
  EXPECT_GT(total[0.01], 600.0);
  EXPECT_NEAR(total[0.1], total[0.01], 120.0);
  EXPECT_NEAR(total[1.0], total[0.01], 120.0);
}

TEST_F(SlotTagFieldTest, ASlotTakesItsTime) {
  bare_physics();
  air.t0_s = 1e-3;  // every tag takes part in every round
  settings.session = 2;
  tags_at({0.5, 0.0, 0.0}, 300);
  const auto reads = fresh(3.0);
  ASSERT_EQ(reads.size(), 300U);
  const double least_s = 1e-6 * slot_times(slots.link, 2).success_us;
  for (std::size_t i = 1; i < reads.size(); ++i)
    ASSERT_GE(hal::to_seconds(reads[i].at - reads[i - 1].at), least_s - 2e-9);
  // A single round with the Q algorithm: about 195 tags/s (2 replies of a round in view of 300 differ by 3
  // %).
  const double seconds = hal::to_seconds(reads.back().at - reads.front().at);
  EXPECT_NEAR(299.0 / seconds, 195.0, 20.0);
}

TEST_F(SlotTagFieldTest, EveryPortHearsItsOwnSide) {
  four_ports();
  for (const hal::Vec3 side : {hal::Vec3{1.2, 0.0, 0.0}, {0.0, 1.2, 0.0}, {-1.2, 0.0, 0.0}, {0.0, -1.2, 0.0}})
    tags_at(side, 10);
  std::map<int, std::size_t> reads;
  for (const AirRead& r : fresh(60.0)) {
    EXPECT_EQ(static_cast<std::uint32_t>(r.port - 1), r.tag / 10);
    ++reads[r.port];
  }
  for (int port = 1; port <= 4; ++port) EXPECT_GT(reads[port], 20U) << port;
}

TEST_F(SlotTagFieldTest, CaptureSparesCollisions) {
  bare_physics();
  air.t0_s = 1e-3;
  settings.session = 2;
  tags_at({0.5, 0.0, 0.0}, 200);
  tags_at({1.0, 0.0, 0.0}, 200);
  const auto time_of = [&](double probability) {
    slots.capture_probability = probability;
    const auto reads = fresh(10.0);
    EXPECT_EQ(reads.size(), 400U);
    std::int64_t lead = 0;  // of the near half over the far one in the first hundred reads
    for (std::size_t i = 0; i < 100 && i < reads.size(); ++i) lead += reads[i].tag < 200 ? 1 : -1;
    return std::pair{hal::to_seconds(reads.back().at), lead};
  };
  const auto [without, even] = time_of(0.0);
  EXPECT_EQ(statistics.captured, 0U);
  const auto [with, lead] = time_of(0.9);
  EXPECT_GT(statistics.captured, 80U);
  EXPECT_LT(with, 0.95 * without);
  EXPECT_LT(std::abs(even), 41);  // four deviations of a fair coin
  EXPECT_GT(lead, even) << "the stronger one wins";
}

TEST_F(SlotTagFieldTest, AFixedQHasItsPrice) {
  bare_physics();
  air.t0_s = 1e-3;
  settings.session = 2;
  tags_at({0.5, 0.0, 0.0}, 64);
  std::map<int, double> time;
  for (const int q : {3, 6, 11}) {
    settings.q = q;
    const auto reads = fresh(20.0);
    EXPECT_EQ(unique(reads), 64U) << q;
    time[q] = hal::to_seconds(reads.back().at);
  }
  EXPECT_LT(time[6], 0.5);
  EXPECT_GT(time[3], 1.5 * time[6]) << "collisions";
  EXPECT_GT(time[11], 1.5 * time[6]) << "empty slots";
}

TEST_F(SlotTagFieldTest, ReportsSayHowStrongWhereAndOnWhichChannel) {
  bare_physics();
  air.rssi_noise_db = 0.0;
  tags_at({1.3, 0.0, 0.0}, 1);
  const auto reads = fresh(60.0);
  ASSERT_GT(reads.size(), 20U);
  for (const AirRead& r : reads) {
    EXPECT_EQ(r.rssi_dbm, std::lround(-53.0 - 40.0 * std::log10(1.3)));
    const double wavelength_m = 299792.458 / r.frequency_khz;
    EXPECT_NEAR(r.phase_deg, std::fmod(720.0 * 1.3 / wavelength_m, 180.0), 0.51);
    EXPECT_EQ((r.frequency_khz - 865700U) % 600U, 0U);
  }
  settings.ports[0].sensitivity_dbm = -50.0;
  EXPECT_TRUE(fresh(60.0).empty());
  EXPECT_GT(statistics.too_weak, 20U);
}

TEST_F(SlotTagFieldTest, TheBoundItDrawsUnderHoldsOnAWildRide) {
  four_ports();
  for (int i = 0; i < 100; ++i) tags_at({0.15 * i, 1.75, 0.0}, 4);
  drive = [this](double t) {
    body.body.pose.position = {7.0 + 6.0 * std::sin(0.3 * t), 0.6 * std::sin(1.1 * t),
                               1.2 + 0.5 * std::sin(0.7 * t)};
    body.body.pose.yaw_rad = hal::wrap_pi(2.0 * t);
    body.body.pose.roll_rad = 0.3 * std::sin(t);
  };
  EXPECT_GT(fresh(60.0, 0.02).size(), 300U);
  EXPECT_EQ(statistics.bound_exceeded, 0U);
}

TEST_F(SlotTagFieldTest, EqualSeedsGiveEqualReadsOthersDiffer) {
  tags_in_view(50);
  const auto times = [&](std::uint64_t seed) {
    std::vector<std::int64_t> at;
    for (const AirRead& r : fresh(5.0, 0.1, seed)) at.push_back(r.at.time_since_epoch().count());
    return at;
  };
  EXPECT_EQ(times(1), times(1));
  EXPECT_NE(times(1), times(2));
}

TEST_F(SlotTagFieldTest, ListeningAllocatesNothing) {
  four_ports();
  settings.session = 2;
  settings.target = '*';
  tags_in_view(300);
  SlotTagField f = field();
  std::vector<AirRead> reads;
  reads.reserve(100000);
  f.radio_on(settings, now);
  f.advance(now + 20s, reads);  // every tag in reach has been met
  const std::uint64_t before = test::allocation_count();
  for (int i = 21; i < 40; ++i) f.advance(now + i * 1s, reads);
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_GT(reads.size(), 1000U);
}

TEST(SlotParameters, NonsenseIsRefusedAndSaidWhy) {
  const AirParameters air;
  const auto why = [&air](const SlotParameters& slots) {
    const auto valid = validate(slots, air);
    return valid ? std::string("accepted") : valid.error().detail;
  };
  EXPECT_EQ(why({}), "accepted");
  SlotParameters slots;
  slots.q_step = 0.0;
  EXPECT_NE(why(slots).find("q_step"), std::string::npos);
  slots = {};
  slots.link.m = 5;
  EXPECT_NE(why(slots).find("m = 5"), std::string::npos);
  slots = {};
  slots.capture_probability = std::nan("");
  EXPECT_NE(why(slots).find("capture_probability"), std::string::npos);
  slots = {};
  slots.hop_interval_s = 0.002;
  EXPECT_NE(why(slots).find("one read takes"), std::string::npos);
  AirParameters hasty;
  hasty.max_dwell_s = 0.005;
  EXPECT_FALSE(validate(SlotParameters{}, hasty));
}

}  // namespace
}  // namespace forager::mocks
