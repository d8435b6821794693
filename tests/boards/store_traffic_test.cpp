// What the simulated reader puts on the wire in a store, against recordings of such runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "boards/sim_air.hpp"
#include "boards/world_builder.hpp"
#include "tests/boards/flown_mission.hpp"

namespace forager::boards {
namespace {

struct CarriedBody final : mocks::TrueBody {
  mocks::BodyState body;
  [[nodiscard]] const mocks::BodyState& state() const override { return body; }
};

struct Traffic {
  double mean_per_s = 0.0;
  int peak_per_s = 0;      // in the busiest second
  int peak_new_per_s = 0;  // EPCs never read before
  int weakest_dbm = 0;
  int strongest_dbm = 0;
  int median_dbm = 0;
  std::size_t reads = 0;
  std::size_t tags = 0;
};

mocks::RadioSettings radio_of(const Scene& scene) {
  mocks::RadioSettings radio;
  radio.session = static_cast<int>(scene.read_plan.session);
  radio.on_time = scene.read_plan.on_time;
  radio.off_time = scene.read_plan.off_time;
  for (const reader::ReadPort& port : scene.read_plan.ports) radio.ports.push_back({port.port, 30.0, -82.0});
  return radio;
}

// Carries the reader along the scene's way at its speed.
Traffic walk(const Scene& scene, std::uint64_t seed) {
  const mocks::World world = build_world(scene, seed);
  CarriedBody body;
  body.body.pose.position = {0.0, 0.0, scene.vehicle.altitude_m};
  const auto field = make_field(scene, world, body, seed);
  std::vector<mocks::AirRead> reads;
  field->radio_on(radio_of(scene), {});
  const double length_m = scene.mission.waypoints.front().x;
  const double seconds = length_m / scene.mission.speed_m_s;
  for (int i = 1; i <= static_cast<int>(20.0 * seconds); ++i) {
    body.body.pose.position.x = 0.05 * i * scene.mission.speed_m_s;
    field->advance(hal::Instant{} + hal::from_seconds(0.05 * i), reads);
  }
  Traffic traffic;
  std::set<std::uint32_t> seen;
  std::vector<int> rssi;
  std::vector<int> per_second(static_cast<std::size_t>(seconds) + 2);
  std::vector<int> new_per_second(per_second.size());
  for (const mocks::AirRead& r : reads) {
    const auto second = static_cast<std::size_t>(hal::to_seconds(r.at));
    ++per_second[second];
    new_per_second[second] += seen.insert(r.tag).second ? 1 : 0;
    rssi.push_back(r.rssi_dbm);
  }
  std::sort(rssi.begin(), rssi.end());
  traffic.reads = reads.size();
  traffic.tags = seen.size();
  traffic.mean_per_s = static_cast<double>(reads.size()) / seconds;
  traffic.peak_per_s = *std::max_element(per_second.begin(), per_second.end());
  traffic.peak_new_per_s = *std::max_element(new_per_second.begin(), new_per_second.end());
  if (rssi.empty()) return traffic;
  traffic.weakest_dbm = rssi.front();
  traffic.strongest_dbm = rssi.back();
  traffic.median_dbm = rssi[rssi.size() / 2];
  return traffic;
}

class StoreTraffic : public testing::TestWithParam<AirModel> {};

TEST_P(StoreTraffic, LiesWithinTheRecordedBands) {
  Scene scene = published_scene("store-dense");
  scene.world.air.model = GetParam();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Traffic t = walk(scene, seed);
    EXPECT_GE(t.mean_per_s, 9.0);
    EXPECT_LE(t.mean_per_s, 41.0);
    EXPECT_GE(t.peak_per_s, 108);
    EXPECT_LE(t.peak_per_s, 173);
    EXPECT_GE(t.peak_new_per_s, 93);
    EXPECT_LE(t.peak_new_per_s, 173);
    EXPECT_LE(t.median_dbm, -70);
    EXPECT_GE(t.median_dbm, -77);
    EXPECT_GE(t.weakest_dbm, -83);
    EXPECT_LE(t.strongest_dbm, -41);
  }
}

TEST_P(StoreTraffic, InTheSameTimeS1FindsMoreTagsThanS0WithFewerReadsEach) {
  Scene scene = published_scene("store-dense");
  scene.world.air.model = GetParam();
  Traffic total[2];
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const auto session : {reader::Session::s0, reader::Session::s1}) {
      scene.read_plan.session = session;
      const Traffic t = walk(scene, seed);
      Traffic& sum = total[session == reader::Session::s1 ? 1 : 0];
      sum.reads += t.reads;
      sum.tags += t.tags;
    }
  EXPECT_GT(total[1].tags, total[0].tags);
  const auto reads_per_tag = [](const Traffic& t) {
    return static_cast<double>(t.reads) / static_cast<double>(t.tags);
  };
  EXPECT_LT(reads_per_tag(total[1]), 0.95 * reads_per_tag(total[0]));
}

INSTANTIATE_TEST_SUITE_P(Models, StoreTraffic, testing::Values(AirModel::round, AirModel::slot),
                         [](const auto& model) {
                           return model.param == AirModel::slot ? std::string("Slot") : std::string("Round");
                         });

}  // namespace
}  // namespace forager::boards
