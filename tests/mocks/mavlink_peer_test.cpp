#include "mocks/mavlink_peer.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hal/random.hpp"

namespace forager::mocks {
namespace {

// Golden frames of common.xml messages from system 42, component 191, with random field values; the signed
// one with the key sha256("spool-test-key").
struct Golden {
  peer::MessageKind kind;
  int sequence;
  const char* payload;
  const char* v2;
  const char* v1;         // empty: the id does not fit
  const char* v2_signed;  // empty: not tried
};

const std::vector<Golden> kGolden = {
    Golden{peer::kHeartbeat, 139, "3a704681d757a99203", "fd0900008b2abf0000003a704681d757a99203d924",
           "fe098b2abf003a704681d757a99203eb38", ""},
    Golden{peer::kHeartbeat, 49, "000000000000000003", "fd090000312abf0000000000000000000000034515",
           "fe09312abf000000000000000000031f64", ""},
    Golden{peer::kParamValue, 59, "0080e140bad2795264737a756d787073726c63757177747384",
           "fd1900003b2abf1600000080e140bad2795264737a756d787073726c637571777473843024",
           "fe193b2abf160080e140bad2795264737a756d787073726c63757177747384618c", ""},
    Golden{peer::kParamSet, 189, "005225c4fa5f766f706e78696671666f717673666c7a5c",
           "fd170000bd2abf170000005225c4fa5f766f706e78696671666f717673666c7a5c06aa",
           "fe17bd2abf17005225c4fa5f766f706e78696671666f717673666c7a5cc5d8", ""},
    Golden{peer::kAttitude, 228, "b701e8a1004d38c4804182c400511a440006e243000899c20024fec3",
           "fd1c0000e42abf1e0000b701e8a1004d38c4804182c400511a440006e243000899c20024fec31077",
           "fe1ce42abf1eb701e8a1004d38c4804182c400511a440006e243000899c20024fec3bd51", ""},
    Golden{peer::kLocalPositionNed, 111, "e02793f7003292c38050a64400cb40c400d2ce43002aaa430070f9c2",
           "fd1c00006f2abf200000e02793f7003292c38050a64400cb40c400d2ce43002aaa430070f9c21500",
           "fe1c6f2abf20e02793f7003292c38050a64400cb40c400d2ce43002aaa430070f9c2e1ba", ""},
    Golden{peer::kCommandLong, 120, "80a481c4009c84c3002dbec4003752c400008ac38057b8c4007e86c34b8f0b5104",
           "fd210000782abf4c000080a481c4009c84c3002dbec4003752c400008ac38057b8c4007e86c34b8f0b51"
           "046707",
           "fe21782abf4c80a481c4009c84c3002dbec4003752c400008ac38057b8c4007e86c34b8f0b5104c49e",
           "fd210100782abf4c000080a481c4009c84c3002dbec4003752c400008ac38057b8c4007e86c34b8f0b51"
           "04cba5075104030201000055c74ab114"},
    Golden{peer::kCommandAck, 89, "49216855efde442f2564", "fd0a0000592abf4d000049216855efde442f25644d34",
           "fe03592abf4d492168b5a3", ""},
    Golden{peer::kCommandAck, 14, "00000000000000000000", "fd0100000e2abf4d0000003121",
           "fe030e2abf4d000000941c", ""},
    Golden{peer::kSetPositionTargetLocalNed, 148,
           "76899c5000c22d4400c07ac2008a41c480b8984400d734c4003412c30070fec2001d31c400458c440073"
           "52c4006a8cc3a3a9586248",
           "fd350000942abf54000076899c5000c22d4400c07ac2008a41c480b8984400d734c4003412c30070fec2"
           "001d31c400458c44007352c4006a8cc3a3a95862484f0b",
           "fe35942abf5476899c5000c22d4400c07ac2008a41c480b8984400d734c4003412c30070fec2001d31c4"
           "00458c44007352c4006a8cc3a3a9586248a01b",
           ""},
    Golden{peer::kVisionPositionEstimate, 11,
           "8ac79c7da9aaf65800b3854480a88fc4009f4244007c7f4400aa224400ac284300182c4400959e440042"
           "6d4400a9624400eeb3c480429cc400bd4844003b2f44002efbc300400e4100f03d4400babac300053cc4"
           "005d60c4002af24300305d4380038f44809ebdc480c5be4400a6324480b788c495",
           "fd7500000b2abf6600008ac79c7da9aaf65800b3854480a88fc4009f4244007c7f4400aa224400ac2843"
           "00182c4400959e4400426d4400a9624400eeb3c480429cc400bd4844003b2f44002efbc300400e4100f0"
           "3d4400babac300053cc4005d60c4002af24300305d4380038f44809ebdc480c5be4400a6324480b788c4"
           "955b07",
           "fe200b2abf668ac79c7da9aaf65800b3854480a88fc4009f4244007c7f4400aa224400ac2843eb07", ""},
    Golden{peer::kTimesync, 232, "4d959093d1a6120ff19556772170b961853b",
           "fd120000e82abf6f00004d959093d1a6120ff19556772170b961853bc1fe",
           "fe10e82abf6f4d959093d1a6120ff19556772170b961884a", ""},
    Golden{peer::kTimesync, 241, "000000000000000000000000000000000000", "fd010000f12abf6f000000eedb",
           "fe10f12abf6f00000000000000000000000000000000e4f9", ""},
    Golden{peer::kBatteryStatus, 156,
           "845931d1b8f2f74ffbba3a402cfac8b08bba4222a50865d4c74a21716278e4a16cdb2a4a403a3c4149ab"
           "5f1d6b8c7bec1653da44a05a",
           "fd3600009c2abf930000845931d1b8f2f74ffbba3a402cfac8b08bba4222a50865d4c74a21716278e4a1"
           "6cdb2a4a403a3c4149ab5f1d6b8c7bec1653da44a05aa838",
           "fe249c2abf93845931d1b8f2f74ffbba3a402cfac8b08bba4222a50865d4c74a21716278e4a16cdb2a4a"
           "3243",
           ""},
    Golden{peer::kStatustext, 130,
           "186c686a716f6a6a76666d6170776c6565746471696c6966706f6d7575757562726476717165656b7074"
           "7564676d7563697574881eef",
           "fd360000822abffd0000186c686a716f6a6a76666d6170776c6565746471696c6966706f6d7575757562"
           "726476717165656b70747564676d7563697574881eef917d",
           "fe33822abffd186c686a716f6a6a76666d6170776c6565746471696c6966706f6d757575756272647671"
           "7165656b70747564676d7563697574fff6",
           ""},
    Golden{peer::kOdometry, 162,
           "9c5f03bc939aa77e00ea0a4400604343802c92448039b6440058a3c28014bf4400a828448035884400e2"
           "f8c3006829c300aa944300612e4400e9774400a00f4200d055430090b743001d99c4007693c400c28bc4"
           "00e906c400ec7f44002675c4009a694400a2ca4300853d4400b8434400e30ac40078a14400d201440002"
           "754400f996c480959fc4808fa6440062c8c30046cb43807a9cc40072a5c3001c1243009263c40091ac44"
           "80c3bdc4802580c400805e4200e01d4400dc92430056f9c3804a9fc48045b0440026fec3800a97c48081"
           "934400b738c480858fc400e8afc200d724c4e620ac9598",
           "fde90000a22abf4b01009c5f03bc939aa77e00ea0a4400604343802c92448039b6440058a3c28014bf44"
           "00a828448035884400e2f8c3006829c300aa944300612e4400e9774400a00f4200d055430090b743001d"
           "99c4007693c400c28bc400e906c400ec7f44002675c4009a694400a2ca4300853d4400b8434400e30ac4"
           "0078a14400d201440002754400f996c480959fc4808fa6440062c8c30046cb43807a9cc40072a5c3001c"
           "1243009263c40091ac4480c3bdc4802580c400805e4200e01d4400dc92430056f9c3804a9fc48045b044"
           "0026fec3800a97c48081934400b738c480858fc400e8afc200d724c4e620ac959881e4",
           "", ""},
};

std::vector<std::byte> bytes_of(std::string_view hex) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
  return bytes;
}

MavlinkPayload payload_of(std::string_view hex) {
  MavlinkPayload payload;
  const auto bytes = bytes_of(hex);
  for (std::size_t i = 0; i < bytes.size(); ++i) payload.put(i, bytes[i]);
  return payload;
}

std::vector<std::byte> packed(const Golden& golden, bool mavlink1) {
  MavlinkPeerPacker packer(42, 191, mavlink1);
  packer.set_next_sequence(static_cast<std::uint8_t>(golden.sequence));
  const auto frame = packer.pack(golden.kind, payload_of(golden.payload));
  return {frame.begin(), frame.end()};
}

TEST(MavlinkPeer, TheChecksumIsMcrf4xx) {
  const std::string digits = "123456789";
  EXPECT_EQ(mavlink_peer_crc(std::as_bytes(std::span(digits))), 0x6F91);
}

TEST(MavlinkPeer, PacksTheGoldenFrames) {
  for (const Golden& golden : kGolden) {
    EXPECT_EQ(packed(golden, false), bytes_of(golden.v2)) << golden.kind.id;
    EXPECT_EQ(packed(golden, true), bytes_of(golden.v1)) << golden.kind.id;
  }
}

TEST(MavlinkPeer, ReadsTheGoldenFrames) {
  for (const Golden& golden : kGolden) {
    for (const char* hex : {golden.v2, golden.v2_signed}) {
      const auto bytes = bytes_of(hex);
      if (bytes.empty()) continue;
      MavlinkPeerParser parser;
      ASSERT_EQ(parser.push(bytes), bytes.size());
      const MavlinkPeerFrame* frame = parser.next();
      ASSERT_NE(frame, nullptr) << golden.kind.id;
      EXPECT_EQ(frame->id, golden.kind.id);
      EXPECT_EQ(frame->system, 42);
      EXPECT_EQ(frame->component, 191);
      EXPECT_EQ(frame->sequence, golden.sequence);
      const auto want = bytes_of(golden.payload);
      const auto got = frame->payload.bytes(golden.kind.full_size);
      EXPECT_TRUE(std::equal(got.begin(), got.end(), want.begin(), want.end())) << golden.kind.id;
      EXPECT_EQ(parser.next(), nullptr);
      EXPECT_EQ(parser.bad(), 0u);
    }
  }
}

// All golden frames in a row, cut into random pieces with noise between them: every frame is found.
TEST(MavlinkPeer, FindsFramesInNoiseHoweverTheyAreCut) {
  hal::Random random(3);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::byte> line;
    std::size_t sent = 0;
    for (const Golden& golden : kGolden) {
      for (const char* hex : {golden.v2, golden.v1, golden.v2_signed}) {
        const auto bytes = bytes_of(hex);
        if (!bytes.empty()) ++sent;
        // Noise that cannot begin a frame, so that none is due to be lost in it.
        for (std::uint64_t n = random.below(20); n > 0; --n)
          line.push_back(static_cast<std::byte>(random.below(0xFD)));
        line.insert(line.end(), bytes.begin(), bytes.end());
      }
    }
    MavlinkPeerParser parser;
    std::size_t found = 0;
    std::span<const std::byte> rest(line);
    while (!rest.empty()) {
      const auto piece = rest.first(std::min<std::size_t>(rest.size(), 1 + random.below(300)));
      rest = rest.subspan(parser.push(piece));
      while (parser.next() != nullptr) ++found;
    }
    EXPECT_EQ(found, sent);
  }
}

TEST(MavlinkPeer, OneBentBitLosesOneFrameOnly) {
  const auto good = bytes_of(kGolden[0].v2);
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    auto bent = good;
    bent[bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
    MavlinkPeerParser parser;
    (void)parser.push(bent);
    std::size_t found = 0;
    // A false length may swallow what follows, up to the longest frame.
    for (int i = 0; i < 20; ++i) {
      (void)parser.push(good);
      while (const MavlinkPeerFrame* frame = parser.next()) {
        EXPECT_EQ(frame->payload.get<std::uint32_t>(0), 2168877114U);
        ++found;
      }
    }
    EXPECT_GE(found, 18u) << bit;
    EXPECT_LE(found, 20u) << bit;
  }
}

TEST(MavlinkPeer, ThrowsAwayFramesWithFlagsItDoesNotKnow) {
  auto frame = bytes_of(kGolden[0].v2);
  frame[2] = std::byte{0x02};
  MavlinkPeerParser parser;
  (void)parser.push(frame);
  EXPECT_EQ(parser.next(), nullptr);
  EXPECT_GE(parser.bad(), 1u);
}

}  // namespace
}  // namespace forager::mocks
