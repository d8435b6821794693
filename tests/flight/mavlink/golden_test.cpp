#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "flight/mavlink/parser.hpp"
#include "flight/mavlink/signing.hpp"
#include "tests/flight/mavlink/message_json.hpp"
#include "tests/places.hpp"

// Every golden frame, both ways: our bytes are those of the official C library, and its bytes read back as
// the values it was given.
namespace forager::flight::mavlink {
namespace {

using test::from_hex;
using test::to_hex;

nlohmann::json golden() {
  return nlohmann::json::parse(std::ifstream(forager::test::data_path("mavlink/golden_frames.json")));
}

SigningKey golden_key(const nlohmann::json& file) {
  SigningKey key{};
  std::ranges::copy(from_hex(file["key"].get<std::string>()), key.begin());
  return key;
}

// Calls use(M{}, case) for each golden frame whose message is known.
template <class Use>
std::size_t for_each_golden(const nlohmann::json& file, Use&& use) {
  std::size_t used = 0;
  for (const auto& frame : file["frames"])
    for_each_message([&](const auto& message) {
      if (frame["name"] != message.kName) return;
      SCOPED_TRACE(frame["name"].get<std::string>() + " " + frame["case"].get<std::string>());
      use(message, frame);
      ++used;
    });
  return used;
}

Sender sender_of(const nlohmann::json& frame) {
  return {frame["sysid"].get<std::uint8_t>(), frame["compid"].get<std::uint8_t>(),
          frame["seq"].get<std::uint8_t>()};
}

template <Message M>
std::optional<M> read_back(const std::string& hex, const nlohmann::json& expected) {
  Parser parser;
  std::optional<M> message;
  int frames = 0;
  parser.feed(from_hex(hex), [&](const Frame& frame) {
    ++frames;
    EXPECT_EQ(frame.id, M::kId);
    EXPECT_EQ(frame.sysid, expected["sysid"]);
    EXPECT_EQ(frame.compid, expected["compid"]);
    EXPECT_EQ(frame.sequence, expected["seq"]);
    EXPECT_EQ(to_hex(frame.bytes), hex);
    message = decode<M>(frame);
  });
  EXPECT_EQ(frames, 1);
  EXPECT_FALSE(parser.has_partial_frame());
  return message;
}

TEST(MavlinkGolden, EncodesMavlink2) {
  const auto file = golden();
  const auto used = for_each_golden(file, [](const auto& type, const nlohmann::json& frame) {
    using M = std::decay_t<decltype(type)>;
    const M message = test::message_from_json<M>(frame["values"]);
    EXPECT_EQ(test::payload_hex(message), frame["payload_full"]);
    Sender sender = sender_of(frame);
    FrameBuffer buffer;
    EXPECT_EQ(to_hex(encode(message, sender, buffer)), frame["v2"]);
  });
  EXPECT_EQ(used, 30U);
}

TEST(MavlinkGolden, EncodesMavlink1WithoutExtensions) {
  std::size_t encoded = 0;
  const auto file = golden();
  for_each_golden(file, [&](const auto& type, const nlohmann::json& frame) {
    using M = std::decay_t<decltype(type)>;
    if constexpr (M::kId <= 0xFF) {
      Sender sender = sender_of(frame);
      FrameBuffer buffer;
      EXPECT_EQ(to_hex(encode_v1(test::message_from_json<M>(frame["values"]), sender, buffer)), frame["v1"]);
      ++encoded;
    }
  });
  EXPECT_EQ(encoded, 26U);
}

TEST(MavlinkGolden, DecodesMavlink2AndMavlink1) {
  const auto file = golden();
  for_each_golden(file, [](const auto& type, const nlohmann::json& frame) {
    using M = std::decay_t<decltype(type)>;
    const auto v2 = read_back<M>(frame["v2"], frame);
    ASSERT_TRUE(v2);
    EXPECT_EQ(test::payload_hex(*v2), frame["payload_full"]);
    if (frame["v1"].is_null()) return;
    const auto v1 = read_back<M>(frame["v1"], frame);
    ASSERT_TRUE(v1);
    const std::string full = frame["payload_full"];
    const std::string base = full.substr(0, 2 * kLayout<M>.base_length);
    EXPECT_EQ(test::payload_hex(*v1), base + std::string(full.size() - base.size(), '0'));
  });
}

TEST(MavlinkGolden, SignsAndVerifies) {
  const auto file = golden();
  const hal::Instant now{};
  for_each_golden(file, [&](const auto& type, const nlohmann::json& frame) {
    using M = std::decay_t<decltype(type)>;
    const std::uint64_t timestamp = frame["sig_timestamp"];
    auto signing = Signing::create(golden_key(file), frame["sig_link_id"], timestamp - 1, now);
    if (!signing) GTEST_SKIP() << hal::describe(signing.error());
    Sender sender = sender_of(frame);
    FrameBuffer buffer;
    encode(test::message_from_json<M>(frame["values"]), sender, buffer, kIncompatSigned);
    ASSERT_TRUE(signing->sign(buffer, now));
    EXPECT_EQ(to_hex(buffer.bytes()), frame["v2_signed"]);

    auto receiver = Signing::create(golden_key(file), 1, timestamp, now);
    Parser parser;
    int good = 0;
    parser.feed(buffer.bytes(), [&](const Frame& f) {
      const auto verdict = receiver->verify(f, now);
      good += verdict && *verdict == SignatureVerdict::good;
      EXPECT_EQ(test::payload_hex(decode<M>(f)), frame["payload_full"]);
    });
    EXPECT_EQ(good, 1);
  });
}

}  // namespace
}  // namespace forager::flight::mavlink
