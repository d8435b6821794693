#include "mocks/store_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace forager::mocks {
namespace {

constexpr StoreKind kKinds[] = {StoreKind::aisles, StoreKind::t, StoreKind::square, StoreKind::halls,
                                StoreKind::random};

World store(const StorePlan& plan, std::uint64_t seed = 1) {
  World world;
  EpcSequence epcs(1, 1);
  hal::Random random(seed);
  const auto made = add_store(world, plan, epcs, random);
  EXPECT_TRUE(made) << describe(made.error());
  return world;
}

bool holds(const Box& box, hal::Vec3 p) {
  return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y && p.z >= box.min.z &&
         p.z <= box.max.z;
}

// Gap between a box and a place on the floor.
double gap(const Box& box, double x, double y) {
  return std::hypot(std::max({box.min.x - x, x - box.max.x, 0.0}),
                    std::max({box.min.y - y, y - box.max.y, 0.0}));
}

class StorePlanTest : public testing::TestWithParam<StoreKind> {};

TEST_P(StorePlanTest, EveryTagLiesOnAShelfAndAllAreThere) {
  for (const std::size_t tags : {1U, 37U, 3000U}) {
    const World world = store({.kind = GetParam(), .tags = tags});
    ASSERT_EQ(world.tags.size(), tags);
    for (std::size_t i = 0; i < tags; ++i)
      ASSERT_TRUE(std::any_of(world.obstacles.begin(), world.obstacles.end(), [&](const Box& box) {
        return holds(box, world.tags.position(i));
      })) << i;
  }
}

TEST_P(StorePlanTest, TheWayInIsFreeAndNoTwoShelvesShareGround) {
  const World world = store({.kind = GetParam(), .tags = 5000});
  for (const Box& box : world.obstacles) {
    EXPECT_GT(gap(box, 0.0, 0.0), 0.9) << "a vehicle 1.2 m across with 0.3 m on both sides";
    for (double x = 0.0; x < 1.4; x += 0.1) EXPECT_GT(gap(box, x, 0.0), 0.9);
    EXPECT_GT(box.max.x, box.min.x);
    EXPECT_GT(box.max.y, box.min.y);
  }
  for (std::size_t i = 0; i < world.obstacles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Box& a = world.obstacles[i];
      const Box& b = world.obstacles[j];
      const double wide = std::min(a.max.x, b.max.x) - std::max(a.min.x, b.min.x);
      const double deep = std::min(a.max.y, b.max.y) - std::max(a.min.y, b.min.y);
      EXPECT_TRUE(wide < 1e-9 || deep < 1e-9) << i << " and " << j;
    }
}

TEST_P(StorePlanTest, TheSameSeedMakesTheSameStore) {
  const World once = store({.kind = GetParam(), .tags = 500}, 3);
  const World again = store({.kind = GetParam(), .tags = 500}, 3);
  const World other = store({.kind = GetParam(), .tags = 500}, 4);
  bool differs = false;
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_EQ(once.tags.position(i), again.tags.position(i));
    ASSERT_EQ(once.tags.epc_hex(i), again.tags.epc_hex(i));
    differs |= once.tags.position(i) != other.tags.position(i);
  }
  EXPECT_TRUE(differs);
}

TEST_P(StorePlanTest, StandsWhereItIsPut) {
  StorePlan plan{.kind = GetParam(), .tags = 200};
  const World here = store(plan);
  plan.origin = {1024.0, -2048.0, 0.0};
  const World there = store(plan);
  ASSERT_EQ(here.obstacles.size(), there.obstacles.size());
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_LT(norm(there.tags.position(i) - here.tags.position(i) - plan.origin), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Kinds, StorePlanTest, testing::ValuesIn(kKinds));

TEST(StorePlan, DensityIsOverTheGroundWithItsAisles) {
  const World world = store({.kind = StoreKind::aisles, .tags = 20'000, .tags_per_m2 = 25.0});
  double max_x = 0.0;
  double min_y = 0.0;
  double max_y = 0.0;
  for (const Box& box : world.obstacles) {
    max_x = std::max(max_x, box.max.x);
    min_y = std::min(min_y, box.min.y);
    max_y = std::max(max_y, box.max.y);
  }
  EXPECT_NEAR(20'000.0 / (max_x * (max_y - min_y)), 25.0, 6.0);
}

TEST(StorePlan, SomeRacksOfARandomStoreAreFullAndSomeNearlyEmpty) {
  const World world = store({.kind = StoreKind::random, .tags = 20'000});
  std::size_t fewest = 20'000;
  std::size_t most = 0;
  for (const Box& box : world.obstacles) {
    std::size_t tags = 0;
    for (std::size_t i = 0; i < world.tags.size(); ++i) tags += holds(box, world.tags.position(i)) ? 1U : 0U;
    fewest = std::min(fewest, tags);
    most = std::max(most, tags);
  }
  EXPECT_GT(most, 5 * fewest);
}

TEST(StorePlan, RefusesWhatIsNoStore) {
  World world;
  EpcSequence epcs(1, 1);
  hal::Random random(1);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity(), 1e9}) {
    StorePlan plan;
    plan.aisle_m = bad;
    EXPECT_FALSE(add_store(world, plan, epcs, random));
  }
  StorePlan none;
  none.tags = 0;
  EXPECT_FALSE(add_store(world, none, epcs, random));
  StorePlan endless;
  endless.tags = 10'000'000;
  endless.tags_per_m2 = 1e-6;
  EXPECT_FALSE(add_store(world, endless, epcs, random));
  EXPECT_TRUE(world.tags.empty());
}

}  // namespace
}  // namespace forager::mocks
