#include "mocks/tag_list.hpp"

#include <gtest/gtest.h>

namespace forager::mocks {
namespace {

TEST(TagList, GivesBackWhatItWasGiven) {
  TagList tags;
  // 96 bits, shorter, longer, upper case, nothing, and text that is no EPC at all.
  const Tag given[] = {{"3034257bf7194e4000001a85", {1.0, 2.0, 3.0}, true},
                       {"3034", {1e6, -1e6, 0.125}, false},
                       {std::string(124, 'f'), {}, true},
                       {"3034257BF7194E4000001A85", {}, true},
                       {"", {}, true},
                       {"303425zbf7194e4000001a85", {}, true}};
  for (const Tag& tag : given) tags.push_back(tag);
  ASSERT_EQ(tags.size(), std::size(given));
  for (std::size_t i = 0; i < tags.size(); ++i) {
    EXPECT_EQ(tags.epc_hex(i), given[i].epc_hex);
    EXPECT_EQ(tags.position(i), given[i].position);
    EXPECT_EQ(tags.wanted(i), given[i].wanted);
    EXPECT_EQ(tags.epc96(i) != nullptr, i == 0) << i;
  }
  EXPECT_EQ(tags.points().x[1], 1e6);
  tags.clear();
  EXPECT_TRUE(tags.empty());
}

TEST(TagList, BytesReadAsTheHexadecimalOfTheSameEpc) {
  TagList tags;
  tags.add({0x30, 0x34, 0x25, 0x7b, 0xf7, 0x19, 0x4e, 0x40, 0x00, 0x00, 0x1a, 0x85}, {}, true);
  EXPECT_EQ(tags.epc_hex(0), "3034257bf7194e4000001a85");
  std::string text = "epc ";
  tags.append_epc_hex(0, text);
  EXPECT_EQ(text, "epc 3034257bf7194e4000001a85");
}

}  // namespace
}  // namespace forager::mocks
