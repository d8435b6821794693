#include "mocks/memory_stream.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <string_view>

namespace forager::mocks {
namespace {

using hal::ErrorCode;
using hal::StreamState;

std::size_t say(hal::ByteStream& end, std::string_view text) {
  return end.write(std::as_bytes(std::span(text))).value();
}

std::string hear(hal::ByteStream& end, std::size_t room = 1024) {
  std::string text(room, '\0');
  text.resize(end.read(std::as_writable_bytes(std::span(text))).value());
  return text;
}

ErrorCode read_error(hal::ByteStream& end) {
  std::byte byte{};
  const auto count = end.read({&byte, 1});
  EXPECT_FALSE(count.has_value());
  return count ? ErrorCode::io : count.error().code;
}

struct MemoryBytes : testing::Test {
  void connect() {
    ASSERT_TRUE(line.near().open().has_value());
    ASSERT_EQ(line.near().poll().value(), StreamState::open);
  }
  MemoryStreamPair line{"line", MemoryStreamKind::bytes, 64};
};

TEST_F(MemoryBytes, ConnectsAndCarriesBothWays) {
  EXPECT_EQ(line.far().poll().value(), StreamState::opening);
  connect();
  EXPECT_EQ(line.far().poll().value(), StreamState::open);
  EXPECT_EQ(say(line.near(), "ab"), 2U);
  EXPECT_EQ(say(line.near(), "cd"), 2U);
  EXPECT_EQ(hear(line.far(), 3), "abc");
  EXPECT_EQ(hear(line.far()), "d");
  EXPECT_EQ(hear(line.far()), "");
  say(line.far(), "back");
  EXPECT_EQ(hear(line.near()), "back");
}

TEST_F(MemoryBytes, ContractOfClosedAndOpenStreams) {
  std::byte byte{};
  EXPECT_EQ(line.near().read({&byte, 1}).error().code, ErrorCode::invalid_state);
  EXPECT_EQ(line.near().write({&byte, 1}).error().code, ErrorCode::invalid_state);
  connect();
  EXPECT_EQ(line.near().open().error().code, ErrorCode::invalid_state);
  EXPECT_EQ(line.near().state(), StreamState::open) << "invalid_state leaves the stream as it is";
}

TEST_F(MemoryBytes, BytesBeforeACloseAreDeliveredBeforeTheError) {
  connect();
  say(line.near(), "last words");
  line.near().close();
  EXPECT_EQ(hear(line.far()), "last words");
  EXPECT_EQ(read_error(line.far()), ErrorCode::disconnected);
  EXPECT_EQ(read_error(line.far()), ErrorCode::invalid_state);

  connect();
  EXPECT_EQ(line.connections(), 2U);
  say(line.far(), "bye");
  line.drop();
  EXPECT_EQ(hear(line.near()), "bye");
  EXPECT_EQ(read_error(line.near()), ErrorCode::disconnected);
}

TEST_F(MemoryBytes, ANewConnectionStartsEmpty) {
  connect();
  say(line.near(), "old");
  line.near().close();
  connect();
  say(line.near(), "new");
  EXPECT_EQ(hear(line.far()), "new");
}

TEST_F(MemoryBytes, ConnectsCanBeRefusedAndHeld) {
  line.refuse_connects(true);
  ASSERT_TRUE(line.near().open().has_value());
  EXPECT_EQ(line.near().poll().error().code, ErrorCode::refused);
  EXPECT_EQ(line.near().state(), StreamState::closed);
  line.refuse_connects(false);
  line.hold_connects(true);
  ASSERT_TRUE(line.near().open().has_value());
  EXPECT_EQ(line.near().poll().value(), StreamState::opening);
  EXPECT_TRUE(line.connecting());
  ASSERT_TRUE(line.accept().has_value());
  EXPECT_TRUE(line.connected());
  EXPECT_EQ(line.accept().error().code, ErrorCode::invalid_state);
}

TEST_F(MemoryBytes, AnEndTheDeviceClosedListensNoMoreUntilItOpens) {
  line.far().close();
  ASSERT_TRUE(line.near().open().has_value());
  EXPECT_EQ(line.near().poll().error().code, ErrorCode::refused);
  ASSERT_TRUE(line.far().open().has_value());
  connect();
}

TEST_F(MemoryBytes, ACutCableIsSilentAndForgetsNothing) {
  connect();
  line.cut(true);
  EXPECT_EQ(say(line.near(), "through the gap"), 15U);
  EXPECT_EQ(hear(line.far()), "");
  line.cut(false);
  EXPECT_EQ(hear(line.far()), "through the gap");
}

TEST_F(MemoryBytes, BackPressureTakesPartOfAWrite) {
  connect();
  line.limit_in_flight(5);
  EXPECT_EQ(say(line.near(), "12345678"), 5U);
  EXPECT_EQ(say(line.near(), "678"), 0U);
  EXPECT_EQ(hear(line.far(), 2), "12");
  EXPECT_EQ(say(line.near(), "678"), 2U);
  line.limit_in_flight(SIZE_MAX);
  EXPECT_EQ(say(line.near(), std::string(100, 'x')), 64U - 5U) << "the buffer itself is a limit";
}

TEST_F(MemoryBytes, AnInjectedErrorStrikesOnceAndClosesBothSides) {
  connect();
  line.near().fail_next({ErrorCode::io, "line", "read", "injected", "", 5});
  EXPECT_EQ(read_error(line.near()), ErrorCode::io);
  EXPECT_EQ(line.near().state(), StreamState::closed);
  EXPECT_EQ(read_error(line.far()), ErrorCode::disconnected);
  connect();
}

RC_GTEST_PROP(MemoryBytesProperty, AnythingWrittenInPiecesIsReadInOrder,
              (const std::vector<std::string>& pieces)) {
  MemoryStreamPair line("line", MemoryStreamKind::bytes, 16);
  RC_ASSERT(line.near().open().has_value() && line.near().poll().has_value());
  std::string written;
  std::string heard;
  for (const std::string& piece : pieces)
    for (std::string_view rest = piece; !rest.empty();) {
      const std::size_t taken = say(line.near(), rest);
      written += rest.substr(0, taken);
      rest.remove_prefix(taken);
      heard += hear(line.far(), 1 + written.size() % 7);
    }
  for (std::string more = hear(line.far()); !more.empty(); more = hear(line.far())) heard += more;
  RC_ASSERT(heard == written);
}

TEST(MemoryDatagrams, KeepTheirBordersAndNobodyWaits) {
  MemoryStreamPair line("udp", MemoryStreamKind::datagrams, 64);
  ASSERT_TRUE(line.near().open().has_value());
  ASSERT_EQ(line.near().poll().value(), StreamState::open);
  say(line.near(), "one");
  say(line.near(), "three");
  EXPECT_EQ(hear(line.far()), "one");
  EXPECT_EQ(hear(line.far(), 2), "th") << "what does not fit is gone";
  EXPECT_EQ(hear(line.far()), "");
  line.far().close();
  EXPECT_EQ(say(line.near(), "to nobody"), 9U);
  ASSERT_TRUE(line.far().open().has_value());
  ASSERT_EQ(line.far().poll().value(), StreamState::open);
  EXPECT_EQ(hear(line.far()), "");
  EXPECT_EQ(say(line.near(), std::string(100, 'x')), 100U) << "too big for the line: lost";
  line.cut(true);
  say(line.near(), "lost");
  line.cut(false);
  EXPECT_EQ(hear(line.far()), "");
  say(line.far(), "reply");
  EXPECT_EQ(hear(line.near()), "reply");
}

}  // namespace
}  // namespace forager::mocks
