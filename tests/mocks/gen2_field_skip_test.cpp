// What the round-level field leaves out: each skip against the field without it.
#include <gtest/gtest.h>

#include "tests/mocks/field_rig.hpp"

namespace forager::mocks {
namespace {

// Along an aisle and round at its end: moves and turns evenly between any two ticks of a second.
hal::Pose up_and_down(double t_s) {
  const double t = std::fmod(t_s, 20.0);
  return {{2.0 + (t < 10.0 ? 0.5 * t : 10.0 - 0.5 * t), 0.0, 1.2}, hal::wrap_pi(0.3 * t_s)};
}

void expect_same_reads(const std::vector<AirRead>& a, const std::vector<AirRead>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].at, b[i].at) << i;
    ASSERT_EQ(a[i].tag, b[i].tag);
    ASSERT_EQ(a[i].rssi_dbm, b[i].rssi_dbm);
  }
}

TEST(FieldSkips, TheGridGivesTheSameReadsToTheByte) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 60'000);
  rig.drive = up_and_down;
  const auto with = rig.listen(10.0, 0.1, 3);
  const FieldStatistics some = rig.statistics;
  rig.air.skip_by_grid = false;
  const auto without = rig.listen(10.0, 0.1, 3);
  EXPECT_GT(with.size(), 500U);
  expect_same_reads(with, without);
  EXPECT_LT(some.examined, rig.statistics.examined / 2) << "or the grid is for nothing";
}

// Reads of many seeds with and without a skip, as shares of each other.
Compared with_and_without(FieldRig& rig, bool AirParameters::*skip, double seconds,
                          std::uint64_t seeds = 40) {
  Compared compared;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto count = [&](bool on) {
      rig.air.*skip = on;
      return static_cast<double>(rig.listen(seconds, 0.1, seed).size());
    };
    const double without = count(false);
    compared.add(without, count(true));
  }
  return compared;
}

// An error of 4 standard errors would be found; the test is worth something if those are 3 % at most.
constexpr double kDeviations = 4.0;
constexpr double kResolution = 0.0075;

TEST(FieldSkips, TagsBehindAreMissedByNobody) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = up_and_down;
  rig.settings.target = '*';
  const Compared compared = with_and_without(rig, &AirParameters::skip_behind, 20.0);
  EXPECT_LT(compared.error(), kResolution);
  EXPECT_LT(compared.deviations(), kDeviations) << compared.difference();
}

TEST(FieldSkips, TagsBehindCostNoDraws) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = up_and_down;
  static_cast<void>(rig.listen(20.0, 0.1, 1));
  const auto draws = rig.statistics.draws;
  rig.air.skip_behind = false;
  static_cast<void>(rig.listen(20.0, 0.1, 1));
  EXPECT_LT(draws, 3 * rig.statistics.draws / 4);
}

TEST(FieldSkips, SilentTagsOfS1AreMissedByNobody) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = up_and_down;
  rig.settings.session = 1;
  const Compared compared = with_and_without(rig, &AirParameters::skip_silent, 20.0);
  EXPECT_LT(compared.error(), kResolution);
  EXPECT_LT(compared.deviations(), kDeviations) << compared.difference();
}

TEST(FieldSkips, SilentTagsOfS2AreMissedByNobody) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  // Away and back, so that power is lost, persistence ends and tags answer a second time.
  rig.drive = [](double t_s) {
    return hal::Pose{{t_s > 15.0 && t_s < 35.0 ? -60.0 : 4.0, 0.0, 1.2}, 0.05 * t_s};
  };
  rig.settings.session = 2;
  const Compared compared = with_and_without(rig, &AirParameters::skip_silent, 60.0, 20);
  EXPECT_LT(compared.error(), kResolution);
  EXPECT_LT(compared.deviations(), kDeviations) << compared.difference();
}

TEST(FieldSkips, ACountedStoreCostsNoDraws) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 1000);
  rig.drive = [](double) { return hal::Pose{{4.0, 0.0, 1.2}}; };
  rig.settings.session = 2;
  static_cast<void>(rig.listen(300.0, 1.0, 1));
  const auto draws = rig.statistics.draws;
  rig.air.skip_silent = false;
  static_cast<void>(rig.listen(300.0, 1.0, 1));
  EXPECT_LT(2 * draws, rig.statistics.draws);
}

TEST(FieldSkips, AnAntennaBeforeNothingDrawsNothing) {
  FieldRig rig;
  // Port 1 looks along +x, away from all tags; port 9 has no antenna.
  rig.antennas = {{1, {}, 0.0, 0.0}};
  rig.settings.ports = {{1, 30.0, -200.0}, {9, 30.0, -200.0}};
  for (int i = 0; i < 500; ++i)
    rig.world.tags.push_back({std::to_string(i), {-3.0 - 0.001 * i, 0.0, 1.0}, true});
  EXPECT_TRUE(rig.listen(30.0, 0.1, 1).empty());
  EXPECT_EQ(rig.statistics.draws, 0U);
  EXPECT_GT(rig.statistics.blind_dwells, 100U);
  rig.air.skip_blind_antennas = false;
  EXPECT_TRUE(rig.listen(30.0, 0.1, 1).empty());
  EXPECT_GT(rig.statistics.draws, 100U);
}

TEST(FieldSkips, AtRestUnchangedGeometryChangesNothing) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = [](double) { return hal::Pose{{4.0, 0.1, 1.2}, 0.2, 0.01, -0.02}; };
  const auto kept = rig.listen(20.0, 0.1, 3);
  const auto views = rig.statistics.views;
  rig.air.unchanged_m = rig.air.unchanged_rad = 0.0;
  expect_same_reads(kept, rig.listen(20.0, 0.1, 3));
  EXPECT_EQ(views, 4U) << "one look from each antenna";
}

TEST(FieldSkips, OnTheMoveUnchangedGeometryMovesTotalsByLessThanThreePercent) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = up_and_down;
  rig.settings.target = '*';
  Compared reads;
  Compared tags;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    rig.air.unchanged_m = rig.air.unchanged_rad = 0.0;
    const auto exact = rig.listen(20.0, 0.1, seed);
    rig.air.unchanged_m = rig.air.unchanged_rad = 0.005;
    const auto kept = rig.listen(20.0, 0.1, seed);
    reads.add(static_cast<double>(exact.size()), static_cast<double>(kept.size()));
    tags.add(static_cast<double>(FieldRig::unique(exact)), static_cast<double>(FieldRig::unique(kept)));
  }
  EXPECT_LT(reads.error(), kResolution);
  EXPECT_LT(reads.deviations(), kDeviations) << reads.difference();
  EXPECT_LT(tags.error(), kResolution);
  EXPECT_LT(tags.deviations(), kDeviations) << tags.difference();
}

}  // namespace
}  // namespace forager::mocks
