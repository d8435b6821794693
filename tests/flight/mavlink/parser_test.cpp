#include "flight/mavlink/parser.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "flight/mavlink/sequence_stats.hpp"
#include "tests/flight/mavlink/message_json.hpp"

namespace forager::flight::mavlink {
namespace {

using Bytes = std::vector<std::byte>;
using test::from_hex;

// The worked frames of the MAVLink texts: an all-zero HEARTBEAT but for its version, system 42.
const Bytes kHeartbeatV2 = from_hex("fd090000312abf0000000000000000000000034515");
const Bytes kHeartbeatV1 = from_hex("fe09312abf000000000000000000031f64");

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Heard {
  std::uint32_t id;
  std::uint8_t sequence;
  Version version;
  friend bool operator==(const Heard&, const Heard&) = default;
};

std::vector<Heard> feed(Parser& parser, const Bytes& bytes) {
  std::vector<Heard> heard;
  parser.feed(bytes, [&](const Frame& f) { heard.push_back({f.id, f.sequence, f.version}); });
  return heard;
}

const Heard kHeardV2{0, 0x31, Version::v2};
const Heard kHeardV1{0, 0x31, Version::v1};

TEST(MavlinkParser, HearsBothVersionsOnOneLine) {
  Parser parser;
  EXPECT_EQ(feed(parser, kHeartbeatV1 + kHeartbeatV2 + kHeartbeatV1),
            (std::vector<Heard>{kHeardV1, kHeardV2, kHeardV1}));
  EXPECT_EQ(parser.stats().skipped_bytes, 0U);
}

TEST(MavlinkParser, HearsAFrameCutAtAnyByte) {
  for (std::size_t cut = 0; cut <= kHeartbeatV2.size(); ++cut) {
    Parser parser;
    const auto at = kHeartbeatV2.begin() + static_cast<std::ptrdiff_t>(cut);
    auto heard = feed(parser, Bytes(kHeartbeatV2.begin(), at));
    for (const Heard& h : feed(parser, Bytes(at, kHeartbeatV2.end()))) heard.push_back(h);
    EXPECT_EQ(heard, std::vector<Heard>{kHeardV2}) << cut;
  }
}

TEST(MavlinkParser, HearsFramesThatComeByteByByte) {
  Parser parser;
  std::size_t heard = 0;
  for (int i = 0; i < 200; ++i)
    for (const std::byte b : kHeartbeatV2 + kHeartbeatV1) heard += feed(parser, Bytes{b}).size();
  EXPECT_EQ(heard, 400U);
}

TEST(MavlinkParser, FindsAFrameRightBehindAFalseStart) {
  // Both start bytes, each announcing a long payload that reaches across the good frame.
  for (const char* garbage : {"fe", "fd", "fe40", "fdff00", "fefefefe", "fdfdfdfd", "fe09fd09", "00fe2112"}) {
    Parser parser;
    auto heard = feed(parser, from_hex(garbage) + kHeartbeatV2 + Bytes(300, std::byte{0}));
    EXPECT_EQ(heard, std::vector<Heard>{kHeardV2}) << garbage;
  }
}

TEST(MavlinkParser, FindsAFrameInsideADamagedOne) {
  Bytes damaged = kHeartbeatV2;
  damaged[12] = std::byte{0xFD};  // a start byte in the payload, and so a wrong CRC
  Parser parser;
  EXPECT_EQ(feed(parser, damaged + kHeartbeatV1 + kHeartbeatV2 + Bytes(300, std::byte{0})),
            (std::vector<Heard>{kHeardV1, kHeardV2}));
  EXPECT_EQ(parser.stats().bad_crc, 1U);
}

TEST(MavlinkParser, AnyFlippedBitIsNoticed) {
  for (std::size_t bit = 8; bit < 8 * kHeartbeatV2.size(); ++bit) {
    Bytes damaged = kHeartbeatV2;
    damaged[bit / 8] ^= std::byte(1U << (bit % 8));
    Parser parser;
    EXPECT_TRUE(feed(parser, damaged + Bytes(300, std::byte{0})).empty()) << bit;
  }
}

TEST(MavlinkParser, DiscardsFramesWithIncompatibleFlags) {
  Bytes frame = kHeartbeatV2;
  frame[2] = std::byte{0x02};
  Parser parser;
  EXPECT_EQ(feed(parser, frame + kHeartbeatV2), std::vector<Heard>{kHeardV2});
  EXPECT_EQ(parser.stats().incompatible, 1U);
}

TEST(MavlinkParser, IgnoresUnknownCompatibilityFlags) {
  // The same heartbeat with compat_flags 0x80; its CRC was computed bit by bit.
  Bytes frame = kHeartbeatV2;
  frame[3] = std::byte{0x80};
  unsigned crc = 0xFFFF;
  const auto add = [&](unsigned byte) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) crc = (crc & 1U) != 0 ? (crc >> 1U) ^ 0x8408U : crc >> 1U;
  };
  for (std::size_t i = 1; i < frame.size() - 2; ++i) add(std::to_integer<unsigned>(frame[i]));
  add(50);
  frame[frame.size() - 2] = std::byte(crc & 0xFFU);
  frame[frame.size() - 1] = std::byte(crc >> 8U);
  Parser parser;
  EXPECT_EQ(feed(parser, frame), std::vector<Heard>{kHeardV2});
}

// A message of another dialect: nothing here knows its id or CRC_EXTRA.
struct Foreign {
  static constexpr std::uint32_t kId = 168;
  static constexpr std::string_view kName = "FOREIGN";
  std::array<std::uint8_t, 32> data{};
  static constexpr auto fields() { return std::tuple{field("data", &Foreign::data)}; }
};

Bytes foreign_frame(std::uint8_t sequence, const Bytes& payload) {
  Foreign foreign;
  std::ranges::transform(payload, foreign.data.begin(),
                         [](std::byte b) { return std::to_integer<std::uint8_t>(b); });
  Sender sender{1, 1, sequence};
  FrameBuffer buffer;
  const auto bytes = encode(foreign, sender, buffer);
  return {bytes.begin(), bytes.end()};
}

TEST(MavlinkParser, CountsUnknownMessagesAndLosesNothingBesideThem) {
  Parser parser;
  const Bytes unknown = foreign_frame(1, from_hex("0102030405060708090a0b0c"));
  EXPECT_EQ(feed(parser, unknown + kHeartbeatV2 + unknown + kHeartbeatV2),
            (std::vector<Heard>{kHeardV2, kHeardV2}));
  EXPECT_EQ(parser.stats().unknown, 2U);
  EXPECT_EQ(parser.stats().bad_crc, 0U);
}

TEST(MavlinkParser, OnceAnUnknownMessageIsEstablishedItsInsideIsNotSearched) {
  Parser parser;
  const Bytes plain = foreign_frame(1, from_hex("0102"));
  EXPECT_TRUE(feed(parser, plain + plain).empty());
  EXPECT_TRUE(feed(parser, foreign_frame(2, kHeartbeatV2)).empty())
      << "a frame tunnelled in another is payload";
  EXPECT_EQ(feed(parser, kHeartbeatV2), std::vector<Heard>{kHeardV2});
}

TEST(MavlinkParser, FlushFreesAFrameHeldBackByAStrayStartByte) {
  Parser parser;
  EXPECT_TRUE(feed(parser, from_hex("fdff0000") + kHeartbeatV2).empty()) << "could still be a long frame";
  std::vector<Heard> heard;
  parser.flush([&](const Frame& f) { heard.push_back({f.id, f.sequence, f.version}); });
  EXPECT_EQ(heard, std::vector<Heard>{kHeardV2});
  EXPECT_FALSE(parser.has_partial_frame());
}

TEST(MavlinkParser, ResetForgetsAPartialFrame) {
  Parser parser;
  EXPECT_TRUE(feed(parser, from_hex("fdff0000")).empty());
  parser.reset();
  EXPECT_EQ(feed(parser, kHeartbeatV2), std::vector<Heard>{kHeardV2});
}

// Good frames with garbage between them, cut anywhere: every good frame is heard, in order. Garbage may by
// chance hold a good frame of its own, at one in 65536 false starts, so it is kept free of known ids.
RC_GTEST_PROP(MavlinkParserProperty, LosesNoFrameInGarbage, ()) {
  const auto pieces = *rc::gen::container<std::vector<std::vector<std::uint8_t>>>(
      8, rc::gen::container<std::vector<std::uint8_t>>(
             rc::gen::element<std::uint8_t>(0xFE, 0xFD, 0x00, 0x01, 0x09, 0xFF, 0x2A)));
  Bytes stream;
  Sender sender{3, 4, 0};
  FrameBuffer buffer;
  for (const auto& piece : pieces) {
    for (const auto b : piece) stream.push_back(std::byte{b});
    LocalPositionNed position;
    position.time_boot_ms = 0xFDFEFDFE;
    position.x = static_cast<float>(piece.size());
    const auto frame = encode(position, sender, buffer);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  stream.resize(stream.size() + 300);
  const auto step = *rc::gen::inRange<std::size_t>(1, 700);
  Parser parser;
  std::vector<unsigned> sequences;
  for (std::size_t at = 0; at < stream.size(); at += step)
    parser.feed(std::span(stream).subspan(at, std::min(step, stream.size() - at)), [&](const Frame& frame) {
      if (frame.id == LocalPositionNed::kId && frame.sysid == 3) sequences.push_back(frame.sequence);
    });
  RC_ASSERT(sequences == (std::vector<unsigned>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(MavlinkSequenceStats, CountsGapsPerSender) {
  SequenceStats stats;
  const auto hear = [&](std::uint8_t sysid, std::uint8_t sequence) {
    Frame frame;
    frame.sysid = sysid;
    frame.compid = 1;
    frame.sequence = sequence;
    stats.count(frame);
  };
  for (const int sequence : {254, 255, 0, 3}) hear(1, static_cast<std::uint8_t>(sequence));
  for (const int sequence : {7, 8}) hear(2, static_cast<std::uint8_t>(sequence));
  ASSERT_NE(stats.find(1, 1), nullptr);
  EXPECT_EQ(stats.find(1, 1)->lost, 2U);
  EXPECT_EQ(stats.find(1, 1)->frames, 4U);
  EXPECT_DOUBLE_EQ(stats.find(1, 1)->loss_fraction(), 2.0 / 6.0);
  EXPECT_EQ(stats.find(2, 1)->lost, 0U);
  EXPECT_EQ(stats.find(2, 9), nullptr);
}

}  // namespace
}  // namespace forager::flight::mavlink
