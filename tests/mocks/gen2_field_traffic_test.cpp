// What a reader reports of a round-level field: traffic, sessions, strength, phase.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/mocks/round_field_fixture.hpp"

namespace forager::mocks {
namespace {

TEST_F(SimTagFieldTest, AStaticReaderSaturates) {
  aisle();
  const auto reads = listen(400.0, 0.1);
  std::set<std::uint32_t> early;
  std::set<std::uint32_t> all;
  for (const AirRead& r : reads) {
    if (hal::to_seconds(r.at) < 200.0) early.insert(r.tag);
    all.insert(r.tag);
  }
  EXPECT_LT(all.size(), 240U) << "of 660: most are out of reach for ever";
  EXPECT_GT(all.size(), 100U);
  EXPECT_LT(all.size() - early.size(), 12U) << "the second half of the time brings next to nothing";
}

TEST_F(SimTagFieldTest, HearsTrafficLikeTheRealThing) {
  aisle();
  body_.body.pose.position.x = 7.0;
  const auto reads = listen(120.0);
  const double rate = static_cast<double>(reads.size()) / 120.0;
  EXPECT_GT(rate, 9.0);
  EXPECT_LT(rate, 45.0);
  std::vector<int> rssi;
  std::vector<int> per_second(121);
  for (const AirRead& r : reads) {
    rssi.push_back(r.rssi_dbm);
    ++per_second[static_cast<std::size_t>(hal::to_seconds(r.at))];
    EXPECT_TRUE(r.rssi_dbm >= -83 && r.rssi_dbm <= -35) << r.rssi_dbm;
    EXPECT_TRUE(r.phase_deg >= 0 && r.phase_deg < 180);
  }
  std::nth_element(rssi.begin(), rssi.begin() + static_cast<std::ptrdiff_t>(rssi.size() / 2), rssi.end());
  EXPECT_TRUE(rssi[rssi.size() / 2] >= -77 && rssi[rssi.size() / 2] <= -68) << rssi[rssi.size() / 2];
  EXPECT_LT(*std::max_element(per_second.begin(), per_second.end()), 174);
}

TEST_F(SimTagFieldTest, SessionsTradeRepeatsForNewTags) {
  bare_physics();
  air_.singulation_s = 1.0 / 300.0;
  tags_at({0.6, 0.0, 0.0}, 600);
  std::size_t total[3] = {};
  std::size_t tags[3] = {};
  for (int session = 0; session < 3; ++session) {
    settings_.session = session;
    const auto reads = listen(2.0);
    total[session] = reads.size();
    tags[session] = unique(reads);
  }
  // The air is full: S0 spends its replies on tags it knows, S1 on few, S2 on none.
  EXPECT_GT(total[0], 380U);
  EXPECT_LT(tags[0], tags[1]);
  EXPECT_LE(tags[1], tags[2]);
  EXPECT_EQ(total[2], tags[2]) << "S2 hears a powered tag once";
  settings_.session = 2;
  EXPECT_LE(listen(300.0, 0.1).size(), 600U);
}

TEST_F(SimTagFieldTest, S2TagsAnswerAgainAfterAnAbsence) {
  bare_physics();
  settings_.session = 2;
  tags_at({1.0, 0.0, 0.0}, 50);
  SimTagField field(world_, body_, antennas_, air_, 1);
  EXPECT_EQ(listen(field, 60.0).size(), 50U);
  // Out of reach for 1.5 s: no timer is shorter than 2 s.
  drive_ = [this](double t) { body_.body.pose.position.x = t > 10.0 && t < 11.5 ? -30.0 : 0.0; };
  EXPECT_EQ(listen(field, 60.0).size(), 0U);
  // Out of reach for 25 s: no timer is longer than 20 s.
  drive_ = [this](double t) { body_.body.pose.position.x = t > 10.0 && t < 35.0 ? -30.0 : 0.0; };
  EXPECT_EQ(listen(field, 60.0).size(), 50U);
}

TEST_F(SimTagFieldTest, TheSensitivityOfThePortHidesWeakReplies) {
  aisle();
  for (auto& p : settings_.ports) p.sensitivity_dbm = -65.0;
  const auto reads = listen(60.0);
  EXPECT_GT(reads.size(), 20U);
  for (const AirRead& r : reads) ASSERT_GE(r.rssi_dbm, -65);
}

TEST_F(SimTagFieldTest, RepliesComeInOrderAndNeverFasterThanTheAirAllows) {
  aisle();
  air_.t0_s = 0.01;
  body_.body.pose.position.x = 7.0;
  const auto reads = listen(20.0);
  EXPECT_GT(reads.size(), 1500U);
  for (std::size_t i = 1; i < reads.size(); ++i)
    ASSERT_GE(hal::to_seconds(reads[i].at - reads[i - 1].at), air_.singulation_s - 2e-9);
}

TEST_F(SimTagFieldTest, PhaseIsTheTwoWayDistance) {
  bare_physics();
  settings_.target = '*';
  tags_at({1.3, 0.0, 0.0}, 1);
  std::set<std::uint32_t> channels;
  for (const AirRead& r : listen(60.0)) {
    const double wavelength_m = 299792.458 / r.frequency_khz;
    EXPECT_NEAR(r.phase_deg, std::fmod(720.0 * 1.3 / wavelength_m, 180.0), 0.51);
    channels.insert(r.frequency_khz);
  }
  EXPECT_EQ(channels, (std::set<std::uint32_t>{865700, 866300, 866900, 867500}));
}

}  // namespace
}  // namespace forager::mocks
