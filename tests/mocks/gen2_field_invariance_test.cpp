// Totals do not depend on the tick, nor on where the world lies and how it is turned. Reads of 40 seeds each
// way; a difference of four standard errors fails. Those are held below 0.75 % of the reads and of the tags
// for ticks, so a bias of 5 % is found with a probability above 0.99 (5 % less 3 % is 2.7 standard errors);
// below 1.25 % for places, where every tag meets another fade: a bias of 8 %.
#include <gtest/gtest.h>

#include "tests/mocks/field_rig.hpp"

namespace forager::mocks {
namespace {

constexpr int kSeeds = 40;
constexpr double kDeviations = 4.0;
constexpr double kTickResolution = 0.0075;
constexpr double kPlaceResolution = 0.0125;

struct Totals {
  Compared reads;
  Compared tags;
  void add(const std::vector<AirRead>& one, const std::vector<AirRead>& other) {
    reads.add(static_cast<double>(one.size()), static_cast<double>(other.size()));
    tags.add(static_cast<double>(FieldRig::unique(one)), static_cast<double>(FieldRig::unique(other)));
  }
  void expect_equal(double resolution) const {
    EXPECT_LT(reads.error(), resolution);
    EXPECT_LT(reads.deviations(), kDeviations) << "reads differ by " << reads.difference();
    EXPECT_LT(tags.error(), resolution);
    EXPECT_LT(tags.deviations(), kDeviations) << "tags differ by " << tags.difference();
  }
};

// Moves and turns evenly within each second.
hal::Pose way(double t_s) { return {{1.0 + 0.5 * t_s, 0.0, 1.2}, hal::wrap_pi(0.4 * t_s)}; }

class FieldTicks : public testing::TestWithParam<double> {};

TEST_P(FieldTicks, TotalsAreThoseOfAHundredthOfASecond) {
  FieldRig rig;
  rig.store(StoreKind::aisles, 3000);
  rig.drive = way;
  Totals totals;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    totals.add(rig.listen(15.0, 0.01, seed), rig.listen(15.0, GetParam(), seed));
  totals.expect_equal(kTickResolution);
}

INSTANTIATE_TEST_SUITE_P(Seconds, FieldTicks, testing::Values(0.1, 1.0));

// The same world somewhere else.
struct Moved {
  double turn_rad;
  hal::Vec3 offset;
};
class FieldPlaces : public testing::TestWithParam<Moved> {};

TEST_P(FieldPlaces, TotalsAreThoseOfTheWorldAtTheOrigin) {
  FieldRig here;
  here.store(StoreKind::aisles, 3000);
  here.drive = way;
  FieldRig there;
  const auto moved = [](hal::Vec3 p) { return GetParam().offset + hal::rotate_yaw(p, GetParam().turn_rad); };
  for (std::size_t i = 0; i < here.world.tags.size(); ++i)
    there.world.tags.push_back({here.world.tags.epc_hex(i), moved(here.world.tags.position(i)), true});
  there.drive = [&moved](double t_s) {
    hal::Pose pose = way(t_s);
    pose.position = moved(pose.position);
    pose.yaw_rad = hal::wrap_pi(pose.yaw_rad + GetParam().turn_rad);
    return pose;
  };
  Totals totals;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed)
    totals.add(here.listen(15.0, 0.1, seed), there.listen(15.0, 0.1, seed));
  totals.expect_equal(kPlaceResolution);
}

INSTANTIATE_TEST_SUITE_P(Places, FieldPlaces,
                         testing::Values(Moved{0.0, {1e6, -1e6, 0.0}}, Moved{0.7, {}},
                                         Moved{-1.5707963267948966, {}}, Moved{2.5, {-1e6, 1e6, 0.0}}));

}  // namespace
}  // namespace forager::mocks
