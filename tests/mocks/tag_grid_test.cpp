#include "mocks/tag_grid.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Cloud {
  std::vector<double> x, y, z;

  void add(double px, double py, double pz) {
    x.push_back(px);
    y.push_back(py);
    z.push_back(pz);
  }
  [[nodiscard]] PointSpans spans() const { return {x, y, z}; }
  [[nodiscard]] std::vector<std::uint32_t> by_looking_at_all(hal::Vec3 c, double radius) const {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < x.size(); ++i)
      if ((x[i] - c.x) * (x[i] - c.x) + (y[i] - c.y) * (y[i] - c.y) + (z[i] - c.z) * (z[i] - c.z) <=
          radius * radius)
        found.push_back(i);
    return found;
  }
};

Cloud scattered(std::size_t count, hal::Vec3 from, hal::Vec3 extent, std::uint64_t seed) {
  hal::Random random(seed);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = from.x + extent.x * random.uniform();
    const double y = from.y + extent.y * random.uniform();
    cloud.add(x, y, from.z + extent.z * random.uniform());
  }
  return cloud;
}

std::vector<std::uint32_t> sorted_within(const TagGrid& grid, hal::Vec3 centre, double radius) {
  std::vector<std::uint32_t> found;
  grid.within(centre, radius, found);
  std::sort(found.begin(), found.end());
  return found;
}

TEST(TagGrid, FindsWhatALookAtEveryTagFinds) {
  const Cloud cloud = scattered(5000, {}, {20.0, 10.0, 2.0}, 1);
  const auto grid = TagGrid::build(cloud.spans());
  ASSERT_TRUE(grid);
  hal::Random random(2);
  std::size_t hits = 0;
  for (int i = 0; i < 300; ++i) {
    const double x = random.uniform(-5.0, 25.0);
    const hal::Vec3 centre{x, random.uniform(-5.0, 15.0), 1.0};
    const double radius = random.uniform(0.0, 8.0);
    const auto found = sorted_within(*grid, centre, radius);
    ASSERT_EQ(found, cloud.by_looking_at_all(centre, radius)) << x << " radius " << radius;
    hits += found.size();
  }
  EXPECT_GT(hits, 10'000U);
}

RC_GTEST_PROP(TagGrid, FindsTheSameSetWhateverTheCells, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  hal::Random random(seed);
  const double offset = *rc::gen::element(0.0, -1e3, 1e6, 1e9);
  const double extent = *rc::gen::element(0.0, 1e-9, 0.5, 30.0, 1e5);
  const double cell = *rc::gen::element(1e-6, 0.1, 1.0, 7.0, 1e9);
  const Cloud cloud = scattered(random.below(300), {offset, -offset, offset},
                                {extent, extent * random.uniform(), 0.1 * extent}, seed);
  const auto grid = TagGrid::build(cloud.spans(), cell);
  RC_ASSERT(grid.has_value());
  for (int i = 0; i < 10; ++i) {
    const double x = offset + extent * random.uniform(-0.2, 1.2);
    const hal::Vec3 centre{x, -offset + extent * random.uniform(-0.2, 1.2), offset};
    const double radius = extent * random.uniform();
    RC_ASSERT(sorted_within(*grid, centre, radius) == cloud.by_looking_at_all(centre, radius));
  }
}

TEST(TagGrid, TagsExactlyOnTheRadiusAndOnCellEdgesBelong) {
  Cloud cloud;
  for (int i = -3; i <= 3; ++i)
    for (int j = -3; j <= 3; ++j) cloud.add(i, j, 0.0);
  const auto grid = TagGrid::build(cloud.spans(), 1.0);
  ASSERT_TRUE(grid);
  EXPECT_EQ(sorted_within(*grid, {}, 1.0).size(), 5U);
  EXPECT_EQ(sorted_within(*grid, {}, 0.0).size(), 1U);
  EXPECT_EQ(sorted_within(*grid, {}, 2.0).size(), 13U);
  EXPECT_EQ(sorted_within(*grid, {}, std::nextafter(2.0, 0.0)).size(), 9U);
}

TEST(TagGrid, OneCellAndNoTags) {
  Cloud cloud;
  for (int i = 0; i < 1000; ++i) cloud.add(4.0, 4.0, 1.0);
  const auto grid = TagGrid::build(cloud.spans());
  ASSERT_TRUE(grid);
  EXPECT_EQ(sorted_within(*grid, {4.0, 4.5, 1.0}, 0.5).size(), 1000U);
  EXPECT_EQ(sorted_within(*grid, {4.0, 4.5, 1.0}, 0.49).size(), 0U);
  const auto empty = TagGrid::build({});
  ASSERT_TRUE(empty);
  EXPECT_TRUE(sorted_within(*empty, {}, 1e9).empty());
  EXPECT_TRUE(sorted_within(TagGrid{}, {}, kInf).empty());
}

TEST(TagGrid, QueriesWithoutMeaningFindNothingAndInfinityFindsAll) {
  const Cloud cloud = scattered(100, {}, {5.0, 5.0, 2.0}, 3);
  const auto grid = TagGrid::build(cloud.spans());
  ASSERT_TRUE(grid);
  EXPECT_TRUE(sorted_within(*grid, {}, -1.0).empty());
  EXPECT_TRUE(sorted_within(*grid, {}, std::nan("")).empty());
  EXPECT_TRUE(sorted_within(*grid, {std::nan(""), 0.0, 0.0}, 5.0).empty());
  EXPECT_TRUE(sorted_within(*grid, {kInf, 0.0, 0.0}, kInf).empty());
  EXPECT_EQ(sorted_within(*grid, {}, kInf).size(), 100U);
  EXPECT_EQ(sorted_within(*grid, {}, 1e300).size(), 100U);
}

TEST(TagGrid, RefusesWhatIsNoPlaceAndSaysWhich) {
  for (const double bad : {std::nan(""), kInf, -kInf, 1e13}) {
    Cloud cloud = scattered(10, {}, {5.0, 5.0, 2.0}, 3);
    cloud.y[7] = bad;
    const auto grid = TagGrid::build(cloud.spans());
    ASSERT_FALSE(grid);
    EXPECT_NE(grid.error().detail.find("point 7"), std::string::npos) << grid.error().detail;
  }
  const Cloud cloud = scattered(10, {}, {5.0, 5.0, 2.0}, 3);
  EXPECT_FALSE(TagGrid::build(cloud.spans(), 0.0));
  EXPECT_FALSE(TagGrid::build(cloud.spans(), std::nan("")));
  EXPECT_FALSE(TagGrid::build(cloud.spans(), std::vector<std::uint32_t>{10}));
}

TEST(TagGrid, APartOfTheTagsKeepsItsIds) {
  const Cloud cloud = scattered(1000, {}, {5.0, 5.0, 2.0}, 4);
  std::vector<std::uint32_t> odd;
  for (std::uint32_t i = 1; i < 1000; i += 2) odd.push_back(i);
  const auto grid = TagGrid::build(cloud.spans(), odd);
  ASSERT_TRUE(grid);
  auto expected = cloud.by_looking_at_all({2.0, 2.0, 1.0}, 2.0);
  std::erase_if(expected, [](std::uint32_t id) { return id % 2 == 0; });
  EXPECT_EQ(sorted_within(*grid, {2.0, 2.0, 1.0}, 2.0), expected);
}

// Two clusters a world apart must not cost memory for the emptiness between them.
TEST(TagGrid, AnEmptyWorldBetweenTwoTagsCostsNoCells) {
  Cloud cloud;
  cloud.add(-1e12, -1e12, 0.0);
  cloud.add(1e12, 1e12, 0.0);
  const auto grid = TagGrid::build(cloud.spans(), 1e-3);
  ASSERT_TRUE(grid);
  EXPECT_GT(grid->cell_m(), 1e9);
  EXPECT_EQ(sorted_within(*grid, {1e12, 1e12, 1.0}, 2.0), (std::vector<std::uint32_t>{1}));
}

}  // namespace
}  // namespace forager::mocks
