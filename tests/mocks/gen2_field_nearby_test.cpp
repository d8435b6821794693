#include "mocks/gen2_field_nearby.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "tests/mocks/field_rig.hpp"

namespace forager::mocks {
namespace {

// A store of 3000 tags round the reader, and the tags near one place in it.
struct Surroundings {
  explicit Surroundings(AirParameters parameters = {}) : air(std::move(parameters)), link(make_link()) {}

  World world = [] {
    FieldRig rig;
    rig.store(StoreKind::random, 3000);
    return rig.world;
  }();
  AirParameters air;
  AirLink link;
  NearbyTags nearby{world, link, air};

 private:
  AirLink make_link() {
    return {world, {{1, {0.1, 0.0, 0.1}, 0.3, 0.1}, {2, {-0.1, 0.0, 0.0}, -2.5, 0.0}}, air, 7};
  }
};

hal::Pose random_pose(hal::Random& random) {
  hal::Pose pose;
  pose.position.x = random.uniform(0.0, 12.0);
  pose.position.y = random.uniform(-6.0, 6.0);
  pose.position.z = random.uniform(0.5, 2.5);
  pose.yaw_rad = random.uniform(-3.0, 3.0);
  pose.pitch_rad = random.uniform(-0.2, 0.2);
  pose.roll_rad = random.uniform(-0.2, 0.2);
  return pose;
}

bool audible(const NearbyTags& nearby, const Audible& ear, std::size_t i) {
  const double middle = nearby.all()[i].sum_per_s - 0.5 * nearby.all()[i].bound_per_s;
  return std::any_of(ear.stretches.begin(), ear.stretches.begin() + static_cast<std::ptrdiff_t>(ear.count),
                     [&](const Audible::Stretch& s) { return middle > s.from_per_s && middle < s.to_per_s; });
}

// The promise everything rests on: whoever could answer is there, under a bound that holds, after any move
// within the slack and any turn within what was allowed for.
void expect_bounds_hold(const AirParameters& air) {
  Surroundings around(air);
  hal::Random random(11);
  constexpr double kSlack_m = 0.5;
  constexpr double kTurn_rad = 0.1;
  std::size_t heard = 0;
  for (int round = 0; round < 60; ++round) {
    const hal::Pose before = random_pose(random);
    around.nearby.renew({before.position, kSlack_m, 1.0}, nullptr);
    std::map<std::uint32_t, std::size_t> place;
    for (std::size_t i = 0; i < around.nearby.all().size(); ++i) place[around.nearby.all()[i].tag] = i;
    for (const int port : {1, 2}) {
      const Audible ear = around.nearby.before(around.link.view(before, {port, 30.0, -80.0}), kTurn_rad);
      hal::Pose after = before;
      const double way = random.uniform(0.0, 2.0 * hal::kPi);
      after.position =
          after.position + kSlack_m * random.uniform() * hal::Vec3{std::cos(way), std::sin(way), 0.0};
      after.yaw_rad += kTurn_rad * random.uniform(-0.6, 0.6);
      after.pitch_rad += kTurn_rad * random.uniform(-0.2, 0.2);
      after.roll_rad += kTurn_rad * random.uniform(-0.2, 0.2);
      const AntennaView view = around.link.view(after, {port, 30.0, -80.0});
      for (std::uint32_t tag = 0; tag < around.world.tags.size(); ++tag) {
        const double rate = around.link.hazard(around.link.link(view, tag));
        if (rate <= 0.0) continue;
        ++heard;
        const auto found = place.find(tag);
        if (found == place.end()) {
          // Only below the hazard cut a tag may be missing.
          ASSERT_LE(rate * air.t0_s, air.hazard_cut);
          continue;
        }
        ASSERT_GE(around.nearby.all()[found->second].bound_per_s, rate) << tag;
        ASSERT_TRUE(audible(around.nearby, ear, found->second)) << tag << " on port " << port;
      }
    }
  }
  EXPECT_GT(heard, 5000U);
}

TEST(NearbyTags, BoundsHoldWithinTheSlackAndTheTurn) { expect_bounds_hold({}); }

TEST(NearbyTags, BoundsHoldForOtherBeams) {
  AirParameters air;
  air.pattern = AntennaPattern::gaussian(1.0, 1.0);
  expect_bounds_hold(air);
  air.pattern = AntennaPattern::cosine_squared(2.0, 1.5);
  expect_bounds_hold(air);
  air.pattern = *AntennaPattern::table({{-hal::kPi, 0.1}, {0.0, 1.0}, {hal::kPi, 0.1}},
                                       {{-1.6, 0.0}, {0.0, 1.0}, {1.6, 0.0}});
  expect_bounds_hold(air);
}

TEST(NearbyTags, BoundsHoldWithoutFadeSpreadOrLimit) {
  AirParameters air;
  air.spread_db = 0.0;
  expect_bounds_hold(air);
  air.rician_k_db = FrozenFade::kNoFade_db;
  air.power_up_limit = std::numeric_limits<double>::infinity();
  air.hazard_cut = 1e-3;
  expect_bounds_hold(air);
}

TEST(NearbyTags, AnAntennaLeavesOutWhatIsBehindIt) {
  Surroundings around;
  around.nearby.renew({{6.0, 0.0, 1.2}, 0.5, 1.0}, nullptr);
  const Audible ear = around.nearby.before(around.link.view({{6.0, 0.0, 1.2}}, {1, 30.0, -80.0}), 0.1);
  EXPECT_GT(ear.total_per_s, 0.2 * around.nearby.sum_per_s());
  EXPECT_LT(ear.total_per_s, 0.8 * around.nearby.sum_per_s());
}

TEST(NearbyTags, PicksInProportionToTheBounds) {
  Surroundings around;
  around.nearby.renew({{6.0, 0.0, 1.2}, 0.5, 1.0}, nullptr);
  const Audible ear = around.nearby.before(around.link.view({{6.0, 0.0, 1.2}}, {2, 30.0, -80.0}), 0.1);
  const auto all = around.nearby.all();
  ASSERT_GT(ear.count, 1U);
  // Through the whole line in even steps: each candidate comes up as often as its bound says.
  constexpr std::size_t kSteps = 2'000'000;
  std::vector<std::size_t> picked(all.size());
  for (std::size_t i = 0; i < kSteps; ++i) {
    const auto& candidate = around.nearby.pick(ear, (static_cast<double>(i) + 0.5) / kSteps);
    ++picked[static_cast<std::size_t>(&candidate - all.data())];
  }
  std::size_t heard = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double share = audible(around.nearby, ear, i) ? all[i].bound_per_s / ear.total_per_s : 0.0;
    ASSERT_NEAR(static_cast<double>(picked[i]), share * kSteps, 1.5) << i;
    heard += share > 0.0 ? 1U : 0U;
  }
  EXPECT_GT(heard, 50U);
  EXPECT_LT(heard, all.size());
}

TEST(NearbyTags, SilentTagsAreLeftOutUntilTheyMayAnswer) {
  Surroundings around;
  SessionFlags flags(around.world.tags.size(), around.air, 3);
  const NearbyTags::Place place{{6.0, 0.0, 1.2}, 0.5, 1.0};
  around.nearby.renew(place, nullptr);
  std::vector<std::uint32_t> tags;
  for (const auto& candidate : around.nearby.all()) tags.push_back(candidate.tag);
  ASSERT_GT(tags.size(), 100U);
  for (const std::uint32_t tag : tags) flags.singulate(tag, 1, 'A', 0.0, 1, 0.0);
  for (const double now : {0.0, 1.0, 3.0, 4.5, 5.0}) {
    const NearbyTags::Silence silence{&flags, 1, 'A', 2, now, now + 1.0};
    around.nearby.renew(place, &silence);
    std::size_t may_answer = 0;
    for (const std::uint32_t tag : tags) may_answer += flags.s1_persistence_s(tag) <= now + 1.0 ? 1U : 0U;
    EXPECT_EQ(around.nearby.all().size(), may_answer) << now;
    EXPECT_EQ(around.nearby.silent(), tags.size() - may_answer);
  }
}

TEST(NearbyTags, TagsWithoutAPlaceAreHeardByNobody) {
  World world;
  world.tags.push_back({"3034", {std::nan(""), 0.0, 1.0}, true});
  world.tags.push_back({"3035", {1.0, 0.0, std::numeric_limits<double>::infinity()}, true});
  world.tags.push_back({"3036", {1.0, 0.0, 1.0}, true});
  const AirParameters air;
  const AirLink link(world, {{1, {}, 0.0, 0.0}}, air, 1);
  NearbyTags nearby(world, link, air);
  nearby.renew({{0.0, 0.0, 1.0}, 0.5, 1.0}, nullptr);
  ASSERT_EQ(nearby.all().size(), 1U);
  EXPECT_EQ(nearby.all()[0].tag, 2U);
}

}  // namespace
}  // namespace forager::mocks
