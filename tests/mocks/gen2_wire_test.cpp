#include "mocks/gen2_wire.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace forager::mocks {
namespace {

std::string text(const Gen2Bits& bits) {
  std::string s;
  for (std::size_t i = 0; i < bits.size(); ++i) s.push_back(bits[i] ? '1' : '0');
  return s;
}

Gen2Bits ascii(const std::string& s) {
  Gen2Bits bits;
  for (const char c : s) bits.push(static_cast<std::uint8_t>(c), 8);
  return bits;
}

std::vector<std::uint8_t> bytes(const std::string& hex) {
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return out;
}

std::uint32_t last16(const Gen2Bits& bits) {
  std::uint32_t value = 0;
  for (std::size_t i = bits.size() - 16; i < bits.size(); ++i) value = value << 1U | (bits[i] ? 1U : 0U);
  return value;
}

TEST(Gen2Wire, CrcsAreTheCatalogued) {
  EXPECT_EQ(gen2_crc5(ascii("123456789")), 0x00);
  EXPECT_EQ(gen2_crc16(ascii("123456789")), 0xD64E);
}

TEST(Gen2Wire, QueriesAreThoseOfTheAir) {
  EXPECT_EQ(text(encode_query({.dr_64_3 = false, .m_log2 = 0, .q = 0})), "1000000000000000010000");
  EXPECT_EQ(text(encode_query({.dr_64_3 = false, .m_log2 = 0, .q = 4})), "1000000000000010011101");
  EXPECT_EQ(text(encode_query({.dr_64_3 = true, .m_log2 = 2, .trext = true, .session = 1, .q = 4})),
            "1000110100010010011001");
  EXPECT_EQ(text(encode_query({.sel = Gen2Select::not_sl, .session = 3, .target = Gen2Target::b, .q = 15}))
                .substr(8, 9),
            "101111111");
}

TEST(Gen2Wire, ShortCommandsAreTheirBits) {
  EXPECT_EQ(text(encode_query_rep(2)), "0010");
  EXPECT_EQ(text(encode_query_adjust(1, Gen2UpDn::up)), "100101110");
  EXPECT_EQ(text(encode_query_adjust(1, Gen2UpDn::same)), "100101000");
  EXPECT_EQ(text(encode_query_adjust(1, Gen2UpDn::down)), "100101011");
  EXPECT_EQ(text(encode_ack(0x8001)), "011000000000000001");
  EXPECT_EQ(text(encode_nak()), "11000000");
}

TEST(Gen2Wire, EpcRepliesCarryTheCrcOfRealTags) {
  // The first one stands in a captured frame of a M6e-Nano with its CRC.
  const auto first = encode_epc_reply(bytes("000000000000000000001545"));
  EXPECT_EQ(first.size(), 128U);
  EXPECT_EQ(last16(first), 0xE94AU);
  EXPECT_EQ(last16(encode_epc_reply(bytes("3005fb63ac1f3841ec880467"))), 0xF29EU);
  EXPECT_EQ(gen2_crc16_register(first), kGen2Crc16Residue);
}

TEST(Gen2Wire, ThePcWordSaysHowLongTheEpcIs) {
  EXPECT_EQ(gen2_pc_word(6), 0x3000);
  EXPECT_EQ(gen2_pc_word(6, true), 0x3400);
  EXPECT_EQ(gen2_pc_word(31, false, true), 0xFA00);
  EXPECT_EQ(encode_epc_reply(std::vector<std::uint8_t>(62, 0xFF)).size(), 16U + 496U + 16U);
}

TEST(Gen2Wire, SelectHas45BitsAndItsMask) {
  Gen2SelectCommand select;
  EXPECT_EQ(encode_select(select).size(), 45U);
  select.mask.push(0xE280, 16);
  EXPECT_EQ(text(encode_select(select)).substr(0, 45),
            "101010000001"
            "00100000"
            "00010000"
            "1110001010000000"
            "0");
  EXPECT_EQ(encode_select(select).size(), 61U);
  select.pointer = 128;  // a second byte
  EXPECT_EQ(text(encode_select(select)).substr(12, 16), "1000000100000000");
  EXPECT_EQ(encode_select(select).size(), 69U);
  select.pointer = 1U << 14U;
  EXPECT_EQ(text(encode_select(select)).substr(12, 24), "100000011000000000000000");
}

RC_GTEST_PROP(Gen2WireProperty, EveryCommandWithItsCrcHasTheResidue, ()) {
  const auto query = encode_query({.dr_64_3 = *rc::gen::arbitrary<bool>(),
                                   .m_log2 = *rc::gen::inRange<std::uint8_t>(0, 4),
                                   .trext = *rc::gen::arbitrary<bool>(),
                                   .session = *rc::gen::inRange<std::uint8_t>(0, 4),
                                   .q = *rc::gen::inRange<std::uint8_t>(0, 16)});
  RC_ASSERT(query.size() == 22U);
  RC_ASSERT(gen2_crc5(query) == 0U);
  Gen2SelectCommand select;
  select.target = *rc::gen::inRange<std::uint8_t>(0, 5);
  select.action = *rc::gen::inRange<std::uint8_t>(0, 8);
  select.pointer = *rc::gen::inRange<std::uint32_t>(0, 1U << 21U);
  for (int i = *rc::gen::inRange(0, 8); i > 0; --i)
    select.mask.push(*rc::gen::arbitrary<std::uint32_t>(), 31);
  RC_ASSERT(gen2_crc16_register(encode_select(select)) == kGen2Crc16Residue);
}

}  // namespace
}  // namespace forager::mocks
