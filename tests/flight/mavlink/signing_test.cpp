#include "flight/mavlink/signing.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "flight/mavlink/codec.hpp"
#include "flight/mavlink/messages_link.hpp"
#include "flight/mavlink/parser.hpp"

namespace forager::flight::mavlink {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

const SigningKey kKey = [] {
  SigningKey key{};
  for (std::size_t i = 0; i < key.size(); ++i) key[i] = std::byte(i + 1);
  return key;
}();
constexpr hal::Instant kStart{};
constexpr std::uint64_t kNow = 30'000'000'000;  // some day in 2024

class MavlinkSigning : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto made = Sha256::create();
    if (!made) GTEST_SKIP() << hal::describe(made.error());
  }

  static Signing make(std::uint64_t timestamp, const SigningKey& key = kKey, std::uint8_t link = 1) {
    return std::move(Signing::create(key, link, timestamp, kStart).value());
  }

  Bytes sign(Signing& signing, hal::Instant now = kStart) {
    FrameBuffer buffer;
    encode(Heartbeat{}, sender_, buffer, kIncompatSigned);
    EXPECT_TRUE(signing.sign(buffer, now));
    return {buffer.bytes().begin(), buffer.bytes().end()};
  }

  static SignatureVerdict verify(Signing& signing, const Bytes& bytes, hal::Instant now = kStart) {
    Parser parser;
    auto verdict = SignatureVerdict::not_signed;
    int frames = 0;
    parser.feed(bytes, [&](const Frame& frame) {
      ++frames;
      verdict = signing.verify(frame, now).value();
    });
    EXPECT_EQ(frames, 1);
    return verdict;
  }

  Sender sender_{1, 1, 0};
};

TEST_F(MavlinkSigning, AcceptsAStreamAndRefusesItsReplay) {
  Signing ours = make(kNow);
  Signing theirs = make(kNow);
  const Bytes first = sign(ours);
  const Bytes second = sign(ours);
  EXPECT_EQ(verify(theirs, first), SignatureVerdict::good);
  EXPECT_EQ(verify(theirs, second), SignatureVerdict::good);
  EXPECT_EQ(verify(theirs, second), SignatureVerdict::replayed);
  EXPECT_EQ(verify(theirs, first), SignatureVerdict::replayed);
}

TEST_F(MavlinkSigning, RefusesAnotherKeyAndAnyChangedSignatureByte) {
  SigningKey other = kKey;
  other[31] ^= std::byte{1};
  Signing ours = make(kNow);
  const Bytes frame = sign(ours);
  Signing stranger = make(kNow, other);
  EXPECT_EQ(verify(stranger, frame), SignatureVerdict::wrong_hash);
  for (std::size_t i = frame.size() - kSignatureSize; i < frame.size(); ++i) {
    Bytes forged = frame;
    forged[i] ^= std::byte{0x10};
    Signing theirs = make(kNow);
    EXPECT_EQ(verify(theirs, forged), SignatureVerdict::wrong_hash) << i;
    EXPECT_EQ(theirs.timestamp(), kNow) << "a bad frame moved our clock";
  }
}

TEST_F(MavlinkSigning, RefusesUnsignedFramesButThoseOfTheRadio) {
  Signing theirs = make(kNow);
  FrameBuffer buffer;
  const auto heartbeat = encode(Heartbeat{}, sender_, buffer);
  EXPECT_EQ(verify(theirs, {heartbeat.begin(), heartbeat.end()}), SignatureVerdict::not_signed);
  const auto radio = encode(RadioStatus{}, sender_, buffer);
  EXPECT_EQ(verify(theirs, {radio.begin(), radio.end()}), SignatureVerdict::exempt);
  EXPECT_TRUE(is_acceptable(SignatureVerdict::exempt));
  EXPECT_FALSE(is_acceptable(SignatureVerdict::not_signed));
}

TEST_F(MavlinkSigning, ANewStreamMayLagAMinuteButNoMore) {
  Signing minute_old = make(kNow - kSigningMaxAge - 1);
  Signing older = make(kNow - kSigningMaxAge - 2);
  Signing theirs = make(kNow);
  EXPECT_EQ(verify(theirs, sign(older)), SignatureVerdict::too_old);
  EXPECT_EQ(verify(theirs, sign(minute_old)), SignatureVerdict::good);
}

TEST_F(MavlinkSigning, OurClockRunsWithTimeAndFollowsGoodFrames) {
  Signing ours = make(kNow);
  sign(ours, kStart + 2s);
  EXPECT_EQ(ours.timestamp(), kNow + 2 * kSigningUnitsPerSecond);
  Signing ahead = make(kNow + 77'000'000);
  EXPECT_EQ(verify(ours, sign(ahead), kStart + 2s), SignatureVerdict::good);
  EXPECT_EQ(ours.timestamp(), kNow + 77'000'001);
  EXPECT_EQ(ours.timestamp(), ahead.timestamp());
}

TEST_F(MavlinkSigning, LinksOfOneSenderAreStreamsOfTheirOwn) {
  Signing one = make(kNow + 500, kKey, 1);
  Signing two = make(kNow, kKey, 2);
  Signing theirs = make(kNow);
  EXPECT_EQ(verify(theirs, sign(one)), SignatureVerdict::good);
  EXPECT_EQ(verify(theirs, sign(two)), SignatureVerdict::good) << "earlier, but on another link";
}

TEST_F(MavlinkSigning, WillNotSignAFrameNotMadeForIt) {
  Signing ours = make(kNow);
  FrameBuffer buffer;
  encode(Heartbeat{}, sender_, buffer);
  EXPECT_EQ(ours.sign(buffer, kStart).error().code, hal::ErrorCode::invalid_argument);
  encode_v1(Heartbeat{}, sender_, buffer);
  EXPECT_EQ(ours.sign(buffer, kStart).error().code, hal::ErrorCode::invalid_argument);
}

TEST(MavlinkSigningTimestamp, CountsTenMicrosecondsFromTheStartOf2015) {
  EXPECT_EQ(signing_timestamp(1'420'070'400s), 0U);
  EXPECT_EQ(signing_timestamp(1'420'070'401s + 10us), 100'001U);
  EXPECT_EQ(signing_timestamp(5s), 0U) << "a board without a clock starts in 1970";
}

}  // namespace
}  // namespace forager::flight::mavlink
