#include "flight/mavlink/codec.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "flight/mavlink/crc.hpp"
#include "flight/mavlink/parser.hpp"
#include "tests/flight/mavlink/message_json.hpp"

namespace forager::flight::mavlink {
namespace {

using test::to_hex;

template <Message M>
std::string v2_hex(const M& message) {
  Sender sender{1, 1, 0};
  FrameBuffer buffer;
  return to_hex(encode(message, sender, buffer));
}

// A frame made by hand from its parts, independent of encode().
std::vector<std::byte> v2_frame(std::uint8_t id, std::uint8_t crc_extra,
                                const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> frame{0xFD, static_cast<std::uint8_t>(payload.size()), 0, 0, 9, 1, 1, id, 0, 0};
  frame.insert(frame.end(), payload.begin(), payload.end());
  std::uint16_t crc = kCrcStart;
  for (std::size_t i = 1; i < frame.size(); ++i) crc = crc_add(crc, frame[i]);
  crc = crc_add(crc, crc_extra);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  std::vector<std::byte> bytes;
  for (const auto b : frame) bytes.push_back(std::byte{b});
  return bytes;
}

template <Message M>
M parse_one(std::span<const std::byte> bytes) {
  Parser parser;
  std::vector<M> messages;
  parser.feed(bytes, [&](const Frame& frame) { messages.push_back(decode<M>(frame)); });
  EXPECT_EQ(messages.size(), 1U);
  return messages.empty() ? M{} : messages.front();
}

TEST(MavlinkCodec, KeepsOneByteOfAnAllZeroPayload) {
  const std::string hex = v2_hex(CommandCancel{});
  EXPECT_EQ(hex.substr(0, 22),
            "fd010000000101500000"
            "00");
  EXPECT_EQ(hex.size(), 2U * (kHeaderV2 + 1 + kCrcSize));
}

TEST(MavlinkCodec, TrimsOnlyTrailingZeros) {
  CommandAck ack;
  ack.command = 400;  // 0x0190: bytes 90 01, then zeros
  EXPECT_EQ(v2_hex(ack).substr(0, 24),
            "fd0200000001014d0000"
            "9001");
  ack.target_component = 191;  // the last byte: nothing to trim
  EXPECT_EQ(v2_hex(ack).substr(0, 40),
            "fd0a00000001014d0000"
            "900100000000000000bf");
}

TEST(MavlinkCodec, AcceptsUntrimmedPayloads) {
  const auto ack = parse_one<CommandAck>(v2_frame(77, 143, {0x90, 0x01, 4, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(ack.command, 400);
  EXPECT_EQ(ack.result, 4);
}

TEST(MavlinkCodec, IgnoresBytesBeyondTheExtensionsItKnows) {
  const auto ack =
      parse_one<CommandAck>(v2_frame(77, 143, {0x90, 0x01, 4, 50, 1, 0, 0, 0, 7, 8, 99, 98, 97}));
  EXPECT_EQ(ack.progress, 50);
  EXPECT_EQ(ack.result_param2, 1);
  EXPECT_EQ(ack.target_component, 8);
}

TEST(MavlinkCodec, ZeroFillsAPayloadShorterThanItsBaseFields) {
  const auto heartbeat = parse_one<Heartbeat>(v2_frame(0, 50, {4, 0, 0, 0, 2}));
  EXPECT_EQ(heartbeat.custom_mode, 4U);
  EXPECT_EQ(heartbeat.type, 2);
  EXPECT_EQ(heartbeat.base_mode, 0);
}

TEST(MavlinkCodec, IgnoresExtensionsInAMavlink1Frame) {
  // Some libraries wrongly append them. Bytes: FE len seq sysid compid id payload crc.
  std::vector<std::uint8_t> frame{0xFE, 10, 0, 1, 1, 77, 0x90, 0x01, 0, 50, 1, 0, 0, 0, 7, 8};
  std::uint16_t crc = kCrcStart;
  for (std::size_t i = 1; i < frame.size(); ++i) crc = crc_add(crc, frame[i]);
  crc = crc_add(crc, std::uint8_t{143});
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8));
  const auto ack = parse_one<CommandAck>(std::as_bytes(std::span(frame)));
  EXPECT_EQ(ack.command, 400);
  EXPECT_EQ(ack.progress, 0);
  EXPECT_EQ(ack.target_component, 0);
}

TEST(MavlinkCodec, KeepsEveryBitOfNanAndNegativeZero) {
  Attitude attitude;
  attitude.roll = std::bit_cast<float>(0x7FC12345U);
  attitude.pitch = std::bit_cast<float>(0xFF800001U);  // signalling
  attitude.yawspeed = -0.0F;
  Sender sender;
  FrameBuffer buffer;
  const auto back = parse_one<Attitude>(encode(attitude, sender, buffer));
  EXPECT_EQ(std::bit_cast<std::uint32_t>(back.roll), 0x7FC12345U);
  EXPECT_EQ(std::bit_cast<std::uint32_t>(back.pitch), 0xFF800001U);
  EXPECT_TRUE(std::signbit(back.yawspeed));
  EXPECT_EQ(buffer.size(), kHeaderV2 + 28 + kCrcSize)
      << "the sign bit of the last float is not a trailing zero";
}

TEST(MavlinkCodec, CountsSequenceNumbersModulo256) {
  Sender sender{1, 1, 254};
  FrameBuffer buffer;
  for (const unsigned expected : {254U, 255U, 0U, 1U})
    EXPECT_EQ(std::to_integer<unsigned>(encode(Heartbeat{}, sender, buffer)[4]), expected);
}

// Any bytes at all are a message; every field, extensions included, survives the wire.
template <Message M>
void check_round_trip(const M& /*type*/) {
  const auto random = *rc::gen::container<std::vector<std::uint8_t>>(kLayout<M>.full_length,
                                                                     rc::gen::arbitrary<std::uint8_t>());
  Frame raw;
  raw.payload = std::as_bytes(std::span(random));
  const M message = decode<M>(raw);
  RC_ASSERT(test::payload_hex(message) == to_hex(raw.payload));

  Sender sender{7, 8, 9};
  FrameBuffer buffer;
  RC_ASSERT(test::payload_hex(parse_one<M>(encode(message, sender, buffer))) == to_hex(raw.payload));
  if constexpr (M::kId <= 0xFF) {
    const std::string back = test::payload_hex(parse_one<M>(encode_v1(message, sender, buffer)));
    RC_ASSERT(back.substr(0, 2 * kLayout<M>.base_length) ==
              to_hex(raw.payload.first(kLayout<M>.base_length)));
    RC_ASSERT(back.find_first_not_of('0', 2 * kLayout<M>.base_length) == std::string::npos);
  }
}

RC_GTEST_PROP(MavlinkCodecProperty, EveryMessageSurvivesTheWire, ()) {
  for_each_message([](const auto& message) { check_round_trip(message); });
}

}  // namespace
}  // namespace forager::flight::mavlink
