#include "reader/advannet_stream.hpp"

#include <gtest/gtest.h>

#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "reader/advannet_events.hpp"
#include "tests/reader/advannet_sample.hpp"
#include "tests/reader/allocation_count.hpp"

namespace forager::reader {
namespace {

struct Outcome {
  std::vector<std::string> bodies;
  bool failed = false;
  AdvanNetStreamCounters counters;
  std::size_t pending = 0;
};

// Feeds `bytes` in pieces whose sizes come from `cuts` (cyclically).
Outcome feed(std::string_view bytes, const std::vector<std::size_t>& cuts = {SIZE_MAX}) {
  AdvanNetStream stream(4096);
  Outcome outcome;
  for (std::size_t i = 0; !bytes.empty() && !outcome.failed; ++i) {
    const auto room = stream.room();
    const std::size_t size = std::min({cuts[i % cuts.size()], room.size(), bytes.size()});
    std::memcpy(room.data(), bytes.data(), size);
    stream.commit(size);
    bytes.remove_prefix(size);
    while (true) {
      const auto body = stream.next();
      outcome.failed = !body;
      if (!body || !*body) break;
      outcome.bodies.emplace_back(**body);
    }
  }
  outcome.counters = stream.counters();
  outcome.pending = stream.pending_bytes();
  return outcome;
}

using Bodies = std::vector<std::string>;

TEST(AdvanNetStream, TakesTheFrameOfTheDeviceAndTheBlankLinesBehindIt) {
  const auto got = feed(
      "ADVANNET/1.1\r\nContent-Length:5\r\nContent-Type:text/xml\r\n\r\nhello\r\n\r\n"
      "ADVANNET/1.0\r\nContent-Length: 2\r\nContent-Type:text/xml\r\n\r\nhi\r\n\r\n");
  EXPECT_EQ(got.bodies, (Bodies{"hello", "hi"}));
  EXPECT_EQ(got.counters.frames, 2U);
  EXPECT_EQ(got.counters.blank_bytes, 8U);
  EXPECT_EQ(got.counters.garbage_lines, 0U);
}

TEST(AdvanNetStream, BothKeepAlivesAreKeepAlives) {
  const auto got = feed(
      "ADVANNET/1.1\r\nContent-Length:0\r\nContent-Type:text/xml\r\n\r\n\r\n\r\n"
      "ADVANNET/1.1\r\nContent-Length:0\r\n\r\n");
  EXPECT_TRUE(got.bodies.empty());
  EXPECT_EQ(got.counters.keepalives, 2U);
  EXPECT_EQ(got.counters.frames, 0U);
}

TEST(AdvanNetStream, HeadersMayBeWrittenInAnyWay) {
  for (const char* header : {"ADVANNET/1.1\nContent-Length:3\nContent-Type:text/xml\n\n",
                             "ADVANNET/1.1\r\ncontent-type: text/xml\r\nCONTENT-LENGTH:   3 \r\n\r\n",
                             "ADVANNET/2.0 future\r\nX-New:1:2\r\nContent-Length:\t3\r\n\r\n",
                             "ADVANNET/1.1\r\nContent-Length:3\r\r\nno colon here\r\n\r\n"})
    EXPECT_EQ(feed(std::string(header) + "abc").bodies, Bodies{"abc"}) << header;
}

TEST(AdvanNetStream, GarbageLinesAreSkippedAndCounted) {
  const std::string long_line(5000, 'x');
  const auto got = feed("GET / HTTP/1.1\r\n\r\n" + long_line + "\n ADVANNET/1.1\n" +
                        "ADVANNET/1.1\r\nContent-Length:1\r\n\r\nA\r\n\r\n");
  EXPECT_EQ(got.bodies, Bodies{"A"});
  EXPECT_EQ(got.counters.garbage_lines, 3U);
  EXPECT_EQ(got.counters.garbage_bytes, 16U + 5001U + 14U);
}

TEST(AdvanNetStream, FrameWithoutUsableLengthIsGivenUpAndTheNextIsFound) {
  for (const char* length :
       {"", "Content-Length:\r\n", "Content-Length:-1\r\n", "Content-Length:+5\r\n", "Content-Length:0x5\r\n",
        "Content-Length:5 5\r\n", "Content-Length:99999999999999999999999\r\n",
        "Content-Length:5\r\nContent-Length:6\r\n"}) {
    const auto got =
        feed(std::string("ADVANNET/1.1\r\n") + length + "\r\nADVANNET/1.1\r\nContent-Length:2\r\n\r\nok");
    EXPECT_EQ(got.bodies, Bodies{"ok"}) << length;
    EXPECT_EQ(got.counters.bad_headers, 1U) << length;
  }
}

TEST(AdvanNetStream, CutOffHeaderDoesNotSwallowTheNextFrame) {
  const auto got = feed("ADVANNET/1.1\r\nADVANNET/1.1\r\nContent-Length:2\r\n\r\nok");
  EXPECT_EQ(got.bodies, Bodies{"ok"});
}

TEST(AdvanNetStream, LengthAboveTheCapIsAnErrorUntilReset) {
  AdvanNetStream stream(4096);
  const std::string_view header = "ADVANNET/1.1\r\nContent-Length:4097\r\n\r\n";
  std::memcpy(stream.room().data(), header.data(), header.size());
  stream.commit(header.size());
  for (int i = 0; i < 2; ++i) {
    const auto body = stream.next();
    ASSERT_FALSE(body);
    EXPECT_EQ(body.error().code, hal::ErrorCode::protocol);
  }
  stream.reset();
  const std::string_view sound = "ADVANNET/1.1\r\nContent-Length:2\r\n\r\nok";
  std::memcpy(stream.room().data(), sound.data(), sound.size());
  stream.commit(sound.size());
  const auto body = stream.next();
  ASSERT_TRUE(body && *body);
  EXPECT_EQ(**body, "ok");
}

TEST(AdvanNetStream, FrameLargerThanTheFirstBufferArrivesWhole) {
  AdvanNetStream stream(1U << 20U);
  const std::string body(300'000, 'b');
  std::string bytes = "ADVANNET/1.1\r\nContent-Length:300000\r\n\r\n" + body;
  std::string_view rest = bytes;
  std::string got;
  while (!rest.empty()) {
    const auto room = stream.room();
    const std::size_t size = std::min<std::size_t>({room.size(), rest.size(), 5000});
    std::memcpy(room.data(), rest.data(), size);
    stream.commit(size);
    rest.remove_prefix(size);
    const auto frame = stream.next();
    ASSERT_TRUE(frame);
    if (*frame) got = **frame;
  }
  EXPECT_EQ(got, body);
}

TEST(AdvanNetStream, SteadyStateAllocatesNothing) {
  AdvanNetStream stream;
  std::string bytes;
  for (int i = 0; i < 40; ++i)
    bytes += "ADVANNET/1.1\r\nContent-Length:1200\r\nContent-Type:text/xml\r\n\r\n" + std::string(1200, 'x') +
             "\r\n\r\n";
  const std::uint64_t before = test::allocation_count();
  std::uint64_t frames = 0;
  for (int round = 0; round < 50; ++round) {
    for (std::string_view rest = bytes; !rest.empty();) {
      const auto room = stream.room();
      const std::size_t size = std::min<std::size_t>({room.size(), rest.size(), 777});
      std::memcpy(room.data(), rest.data(), size);
      stream.commit(size);
      rest.remove_prefix(size);
      while (const auto body = *stream.next()) frames += body->size() == 1200;
    }
  }
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(frames, 2000U);
}

// A stream as it may come: frames, keep-alives, blank lines, garbage, broken headers, in any order.
std::string any_stream(const std::vector<int>& kinds) {
  static const std::array<std::string, 10> kPieces{
      "ADVANNET/1.1\r\nContent-Length:5\r\nContent-Type:text/xml\r\n\r\nhello\r\n\r\n",
      "ADVANNET/1.0\ncontent-length: 3\n\nabc\n",
      "ADVANNET/1.1\r\nContent-Length:0\r\n\r\n",
      "\r\n",
      "garbage: line\r\n",
      "ADVANNET/1.1\r\n",
      "Content-Length:9\r\n",
      "\n",
      "ADVANNET/1.1\r\nContent-Length:5000\r\n\r\n",
      std::string(1500, 'z')};
  std::string bytes;
  for (const int kind : kinds) bytes += kPieces[static_cast<std::size_t>(kind)];
  return bytes;
}

RC_GTEST_PROP(AdvanNetStreamProperty, CuttingChangesNothingAndEveryByteIsAccountedFor, ()) {
  const auto kinds = *rc::gen::container<std::vector<int>>(rc::gen::weightedElement<int>(
      {{10, 0}, {10, 1}, {10, 2}, {5, 3}, {5, 4}, {3, 5}, {3, 6}, {5, 7}, {1, 8}, {2, 9}}));
  const auto cuts =
      *rc::gen::nonEmpty(rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 40)));
  const std::string bytes = any_stream(kinds);
  const Outcome whole = feed(bytes);
  const Outcome pieces = feed(bytes, cuts);
  RC_ASSERT(whole.bodies == pieces.bodies);
  RC_ASSERT(whole.failed == pieces.failed);
  RC_ASSERT(whole.counters.keepalives == pieces.counters.keepalives);
  RC_ASSERT(whole.counters.garbage_lines == pieces.counters.garbage_lines);
  RC_ASSERT(whole.counters.garbage_bytes == pieces.counters.garbage_bytes);
  RC_ASSERT(whole.counters.bad_headers == pieces.counters.bad_headers);
  const auto& c = pieces.counters;
  RC_ASSERT(c.frame_bytes + c.blank_bytes + c.garbage_bytes <= c.bytes);
  if (!pieces.failed) RC_ASSERT(c.bytes == bytes.size());
}

// Reads of a sequence of messages, however TCP cuts and joins them on the way.
RC_GTEST_PROP(AdvanNetStreamProperty, CutsAndJoinsGiveTheSameReads, ()) {
  const auto sizes = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 4));
  std::string bytes;
  std::vector<std::string> wanted;
  for (const int size : sizes) {
    std::string items;
    for (int i = 0; i < size; ++i) {
      wanted.push_back("bd01" + std::to_string(1000 + wanted.size()));
      items += test::advannet_item(wanted.back(), 1779868346683,
                                   "<prop>RSSI:-60</prop><prop>ANTENNA_PORT:1</prop>");
    }
    bytes += test::advannet_frame(test::advannet_inventory(items));
  }
  const auto cuts = *rc::gen::nonEmpty(
      rc::gen::container<std::vector<std::size_t>>(rc::gen::inRange<std::size_t>(1, 2000)));
  std::vector<std::string> got;
  AdvanNetMessage message;
  for (const std::string& body : feed(bytes, cuts).bodies) {
    RC_ASSERT(decode_advannet_message(body, message).has_value());
    for (const TagRead& read : message.reads) got.push_back(read.epc.hex());
  }
  RC_ASSERT(got == wanted);
}

TEST(AdvanNetStream, AfterAResetEveryByteIsAccountedFor) {
  AdvanNetStream stream;
  const std::string_view bytes =
      "junk\r\n\r\nADVANNET/1.1\r\nContent-Length:2\r\n\r\nok\r\nADVANNET/1.1\r\nConte";
  std::memcpy(stream.room().data(), bytes.data(), bytes.size());
  stream.commit(bytes.size());
  while (*stream.next()) {
  }
  stream.reset();
  const auto& c = stream.counters();
  EXPECT_EQ(c.frame_bytes + c.blank_bytes + c.garbage_bytes, bytes.size());
}

}  // namespace
}  // namespace forager::reader
