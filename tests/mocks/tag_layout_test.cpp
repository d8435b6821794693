// Lists of tags that are wrong on purpose: as wrong as was asked for, and no more.
#include "mocks/tag_layout.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>

namespace forager::mocks {
namespace {

TagList row_of(std::size_t count) {
  TagList tags;
  for (std::size_t i = 0; i < count; ++i)  // every fifth has an EPC of another length
    tags.push_back({i % 5 == 4 ? fmt::format("{:08x}", i) : fmt::format("{:024x}", i),
                    {static_cast<double>(i), 0.0, 1.0},
                    i % 3 != 0});
  return tags;
}

TagLayout listed(const TagList& tags, const LayoutFaults& faults, std::uint64_t seed = 1) {
  hal::Random random(seed);
  return layout_of(tags, faults, random);
}

TEST(TagLayout, WithoutFaultsItIsTheWorld) {
  const TagList tags = row_of(20);
  const TagLayout layout = listed(tags, {});
  ASSERT_EQ(layout.tags.size(), 20U);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    EXPECT_EQ(layout.tags.epc_hex(i), tags.epc_hex(i));
    EXPECT_EQ(layout.tags.position(i), tags.position(i));
  }
  EXPECT_TRUE(layout.mislabeled.empty() && layout.unlisted.empty());
}

TEST(TagLayout, OneSwappedLabelTakesASecond) {
  EXPECT_EQ(listed(row_of(100), {.mislabeled = 0.01}).mislabeled.size(), 2U);
  EXPECT_TRUE(listed(row_of(100), {.mislabeled = 0.004}).mislabeled.empty());
  EXPECT_TRUE(listed(row_of(1), {.mislabeled = 1.0}).mislabeled.empty());
}

TEST(TagLayout, FollowsTheSeed) {
  const TagList tags = row_of(200);
  const LayoutFaults faults{.mislabeled = 0.1, .unlisted = 0.1};
  EXPECT_EQ(listed(tags, faults, 3).mislabeled, listed(tags, faults, 3).mislabeled);
  EXPECT_NE(listed(tags, faults, 3).mislabeled, listed(tags, faults, 4).mislabeled);
}

RC_GTEST_PROP(TagLayoutShares, AreKeptAndNobodyElseIsTouched, ()) {
  const auto count = static_cast<std::size_t>(*rc::gen::inRange(2, 300));
  const double mislabeled = *rc::gen::inRange(0, 101) / 100.0;
  const double unlisted = (1.0 - mislabeled) * *rc::gen::inRange(0, 101) / 100.0;
  const TagList tags = row_of(count);
  const TagLayout layout = listed(tags, {mislabeled, unlisted}, *rc::gen::arbitrary<std::uint64_t>());
  const double n = static_cast<double>(count);
  RC_ASSERT(std::abs(static_cast<double>(layout.mislabeled.size()) - mislabeled * n) <= 1.5);
  RC_ASSERT(std::abs(static_cast<double>(layout.unlisted.size()) - unlisted * n) <= 2.0);
  RC_ASSERT(layout.tags.size() == count - layout.unlisted.size());

  const std::set<std::uint32_t> swapped(layout.mislabeled.begin(), layout.mislabeled.end());
  const std::set<std::uint32_t> absent(layout.unlisted.begin(), layout.unlisted.end());
  std::set<double> places_swapped, places_listed;
  std::size_t at = 0;
  for (std::uint32_t tag = 0; tag < count; ++tag) {
    if (absent.contains(tag)) {
      RC_ASSERT(!swapped.contains(tag));
      continue;
    }
    RC_ASSERT(layout.tags.epc_hex(at) == tags.epc_hex(tag));
    RC_ASSERT(layout.tags.wanted(at) == tags.wanted(tag));
    RC_ASSERT((layout.tags.position(at) != tags.position(tag)) == swapped.contains(tag));
    if (swapped.contains(tag)) {
      places_swapped.insert(tags.position(tag).x);
      places_listed.insert(layout.tags.position(at).x);
    }
    ++at;
  }
  RC_ASSERT(places_listed == places_swapped);
}

}  // namespace
}  // namespace forager::mocks
