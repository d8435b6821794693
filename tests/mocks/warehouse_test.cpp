#include "mocks/warehouse.hpp"

#include <gtest/gtest.h>

#include <set>

namespace forager::mocks {
namespace {

using hal::Vec3;

TEST(Warehouse, EpcsAreSgtin96AndUnique) {
  EpcSequence first(0x123456, 0xABCDE, 1);
  EpcSequence other(0x123456, 0xABCDF, 1);
  std::set<std::string> seen;
  for (int i = 0; i < 2000; ++i) {
    for (const std::string& epc : {first.next(), other.next()}) {
      EXPECT_EQ(epc.size(), 24U);
      EXPECT_EQ(epc.substr(0, 2), "30");
      EXPECT_EQ(epc.find_first_not_of("0123456789abcdef"), std::string::npos);
      EXPECT_TRUE(seen.insert(epc).second) << epc;
    }
  }
}

TEST(Warehouse, EpcFieldsSitWhereTheTagDataStandardPutsThem) {
  // Written out by hand: 00110000 001 101 | company | item | serial, in 96 bits.
  EXPECT_EQ(EpcSequence(0, 0, 0).next(), "303400000000000000000000");
  EXPECT_EQ(EpcSequence(0, 0, 1).next(), "303400000000000000000001");
  EXPECT_EQ(EpcSequence(0, 1, 0).next(), "303400000000004000000000");
  EXPECT_EQ(EpcSequence(1, 0, 0).next(), "303400000400000000000000");
  EXPECT_EQ(EpcSequence(0xFFFFFF, 0xFFFFF, 0x3FFFFFFFFF).next(), "3037ffffffffffffffffffff");
}

TEST(Warehouse, ARowIsCentredOnItsLine) {
  const auto row = shelf_row({0.0, 2.0, 0.0}, {10.0, 2.0, 0.0}, 0.8, 2.0);
  ASSERT_TRUE(row);
  EXPECT_EQ(row->min, (Vec3{0.0, 1.6, 0.0}));
  EXPECT_EQ(row->max, (Vec3{10.0, 2.4, 2.0}));
}

TEST(Warehouse, AFaceIsWhereItWasAskedFor) {
  const auto along_x = shelf_with_face({0.0, 1.75, 0.0}, {10.0, 1.75, 0.0}, 1.0, 2.0);
  ASSERT_TRUE(along_x);
  EXPECT_DOUBLE_EQ(along_x->min.y, 1.75);
  EXPECT_DOUBLE_EQ(along_x->max.y, 2.75);
  const auto right = shelf_with_face({0.0, -1.75, 0.0}, {10.0, -1.75, 0.0}, -1.0, 2.0);
  EXPECT_DOUBLE_EQ(right->max.y, -1.75);
  const auto along_y = shelf_with_face({5.0, 8.0, 0.0}, {5.0, -8.0, 0.0}, 1.0, 2.0);
  EXPECT_DOUBLE_EQ(along_y->min.x, 5.0);
  EXPECT_DOUBLE_EQ(along_y->min.y, -8.0);
}

TEST(Warehouse, RefusesWhatIsNoShelf) {
  EXPECT_FALSE(shelf_row({0.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, 1.0, 2.0));
  EXPECT_FALSE(shelf_row({1.0, 1.0, 0.0}, {1.0, 1.0, 0.0}, 1.0, 2.0));
  EXPECT_FALSE(shelf_row({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0, 2.0));
  EXPECT_FALSE(shelf_row({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 1.0, -2.0));
}

TEST(Warehouse, GroupsScatterAroundTheirCentres) {
  World world;
  EpcSequence epcs(1, 1);
  hal::Random random(4);
  add_groups(world, {.centre = {2.0, 1.75, 1.3}, .tags = 30}, {1.17, 0.0, 0.0}, 11, epcs, random);
  ASSERT_EQ(world.tags.size(), 330U);
  double mean_x = 0.0;
  for (std::size_t i = 0; i < world.tags.size(); ++i) {
    const Vec3 centre{2.0 + 1.17 * static_cast<double>(i / 30), 1.75, 1.3};
    const Vec3 p = world.tags[i].position - centre;
    EXPECT_LE(std::abs(p.x), 0.5);
    EXPECT_LE(std::abs(p.y), 0.5);
    EXPECT_TRUE(p.z >= 0.0 && p.z <= 0.5);
    mean_x += p.x / 330.0;
  }
  EXPECT_NEAR(mean_x, 0.0, 0.08);  // 0.29/sqrt(330) = 0.016, five of them
}

TEST(Warehouse, ScatterCanBeKeptInsideAShelf) {
  World world;
  EpcSequence epcs(1, 1);
  hal::Random random(4);
  const Box shelf = *shelf_with_face({0.0, 1.75, 0.0}, {10.0, 1.75, 0.0}, 0.6, 2.0);
  add_group(world, {.centre = {0.2, 1.75, 1.3}, .tags = 500, .wanted = false, .within = shelf}, epcs, random);
  double mean_y = 0.0;
  for (std::size_t i = 0; i < world.tags.size(); ++i) {
    const TagList::View tag = world.tags[i];
    EXPECT_FALSE(tag.wanted);
    EXPECT_TRUE(tag.position.x >= 0.0 && tag.position.x <= 0.7);
    EXPECT_TRUE(tag.position.y >= 1.75 && tag.position.y <= 2.25);
    mean_y += tag.position.y / 500.0;
  }
  EXPECT_NEAR(mean_y, 2.0, 0.03);  // even, not heaped on the face
}

}  // namespace
}  // namespace forager::mocks
