#include "reader/epc.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <unordered_set>

#include "tests/reader/allocation_count.hpp"

namespace forager::reader {
namespace {

TEST(Epc, ReadsHexOfEitherCaseAsTheSameTag) {
  const auto lower = Epc::from_hex("3034257bf7194e4000001a85");
  const auto upper = Epc::from_hex("3034257BF7194E4000001A85");
  ASSERT_TRUE(lower && upper);
  EXPECT_EQ(*lower, *upper);
  EXPECT_EQ(lower->hash(), upper->hash());
  EXPECT_EQ(upper->hex(), "3034257bf7194e4000001a85");
}

TEST(Epc, RefusesWhatNoTagHolds) {
  const std::string too_long(128, 'a');
  for (const std::string& hex :
       {std::string(), std::string("b"), std::string("bd01fa"), std::string("bd01fac"),
        std::string("bd01fag6"), std::string("bd01 ac6"), too_long}) {
    const auto epc = Epc::from_hex(hex);
    ASSERT_FALSE(epc) << hex;
    EXPECT_EQ(epc.error().code, hal::ErrorCode::invalid_argument);
  }
  EXPECT_TRUE(Epc::from_hex(std::string(124, 'f')));
  EXPECT_FALSE(Epc::from_bytes({}));
}

TEST(Epc, ShortTagIsNotItsZeroPaddedSibling) {
  const auto two_bytes = Epc::from_hex("bd01");
  const auto four_bytes = Epc::from_hex("bd010000");
  ASSERT_TRUE(two_bytes && four_bytes);
  EXPECT_NE(*two_bytes, *four_bytes);
  EXPECT_NE(two_bytes->hash(), four_bytes->hash());
}

TEST(Epc, SerialNumbersDoNotCollide) {
  std::unordered_set<std::uint64_t> hashes;
  std::array<std::uint8_t, 12> bytes{0x30, 0x34, 0x25, 0x7B, 0xF7, 0x19, 0x4E, 0x40};
  for (unsigned serial = 0; serial < 100'000; ++serial) {
    bytes[10] = static_cast<std::uint8_t>(serial >> 8U);
    bytes[11] = static_cast<std::uint8_t>(serial);
    bytes[9] = static_cast<std::uint8_t>(serial >> 16U);
    hashes.insert(Epc::from_bytes(bytes)->hash());
  }
  EXPECT_EQ(hashes.size(), 100'000U);
}

TEST(Epc, ParsingAllocatesNothing) {
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(Epc::from_hex("3034257bf7194e4000001a85"));
  EXPECT_EQ(test::allocation_count(), before);
}

RC_GTEST_PROP(EpcProperty, BytesSurviveTheWayThroughHex, (std::vector<std::uint8_t> bytes)) {
  if (bytes.size() % 2 != 0) bytes.pop_back();
  if (bytes.size() > Epc::kMaxBytes) bytes.resize(Epc::kMaxBytes);
  RC_PRE(!bytes.empty());
  const auto epc = Epc::from_bytes(bytes);
  RC_ASSERT(epc.has_value());
  const auto again = Epc::from_hex(epc->hex());
  RC_ASSERT(again.has_value());
  RC_ASSERT(*again == *epc);
  RC_ASSERT(std::vector<std::uint8_t>(again->bytes().begin(), again->bytes().end()) == bytes);
}

}  // namespace
}  // namespace forager::reader
