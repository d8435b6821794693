#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hal/byte_stream.hpp"
#include "tests/hal/byte_stream_rig.hpp"
#include "tests/hal/eventually.hpp"

// The contract of hal::ByteStream as tests, for every implementation alike. Include it in one file of a test
// program and instantiate ByteStreamContract with rigs.
namespace forager::hal::contract {

inline std::string rig_name(const testing::TestParamInfo<RigMaker>& rig) { return rig.param.name; }

inline ErrorCode code_of_read(ByteStream& stream) {
  std::vector<std::byte> room(64);
  Result<std::size_t> result = std::size_t{0};
  const bool failed = eventually([&] {
    result = stream.read(room);
    return !result.has_value();
  });
  if (!failed) ADD_FAILURE() << stream.name() << ": read went on without an error";
  return failed ? result.error().code : ErrorCode::io;
}

class ByteStreamContract : public testing::TestWithParam<RigMaker> {
 protected:
  void connect() {
    ASSERT_TRUE(stream().open().has_value());
    ASSERT_TRUE(eventually([&] {
      rig_->serve();
      const auto state = stream().poll();
      return !state || *state == StreamState::open;
    }));
    rig_->serve();
    ASSERT_EQ(StreamState::open, stream().poll().value());
  }
  // Code with which the pending connect ends.
  ErrorCode code_of_connect() {
    Result<StreamState> state = StreamState::closed;
    EXPECT_TRUE(eventually([&] {
      state = stream().poll();
      return !state.has_value();
    }));
    return state ? ErrorCode::io : state.error().code;
  }
  ByteStream& stream() { return rig_->stream(); }
  ByteStream& peer() { return rig_->peer(); }

  std::unique_ptr<StreamRig> rig_ = GetParam().make();
};

// For streams that keep the order of bytes and notice when the peer goes.
class OrderedContract : public ByteStreamContract {};

// For those of them that connect, and deliver what came before the peer hung up.
class ConnectionContract : public ByteStreamContract {};

// For streams of messages, whose peers do not see each other's state.
class DatagramContract : public ByteStreamContract {};

TEST_P(ByteStreamContract, StartsClosedAndRefusesToCarryBytes) {
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  std::vector<std::byte> room(8);
  EXPECT_EQ(ErrorCode::invalid_state, stream().read(room).error().code);
  EXPECT_EQ(ErrorCode::invalid_state, stream().write(room).error().code);
  stream().close();
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  EXPECT_FALSE(stream().name().empty());
}

TEST_P(ByteStreamContract, SecondOpenIsRefusedAndHarmsNothing) {
  connect();
  EXPECT_EQ(ErrorCode::invalid_state, stream().open().error().code);
  ASSERT_EQ(2U, stream().write(bytes_of("ok")).value());
  EXPECT_EQ("ok", read_text(peer(), 2));
}

TEST_P(ByteStreamContract, CarriesBytesBothWays) {
  connect();
  ASSERT_EQ(4U, stream().write(bytes_of("ping")).value());
  EXPECT_EQ("ping", read_text(peer(), 4));
  ASSERT_EQ(4U, peer().write(bytes_of("pong")).value());
  EXPECT_EQ("pong", read_text(stream(), 4));
}

TEST_P(ByteStreamContract, AnswersAtOnceWhenNothingIsThere) {
  connect();
  std::vector<std::byte> room(8);
  EXPECT_EQ(0U, stream().read(room).value());
  EXPECT_EQ(0U, stream().read({}).value());
  EXPECT_EQ(0U, stream().write({}).value());
  EXPECT_EQ(StreamState::open, stream().poll().value());
}

TEST_P(OrderedContract, NothingIsLostOrTurnedRoundUnderBackPressure) {
  connect();
  constexpr std::size_t kTooMuch = std::size_t{256} << 20;
  const auto pattern = [](std::size_t i) { return static_cast<std::byte>((i * 2654435761U) >> 13); };
  std::vector<std::byte> room(8192);
  std::vector<std::byte> spare(16);
  std::size_t sent = 0;
  std::size_t got = 0;
  for (int round = 0; round < 2; ++round) {  // a stream that was full takes bytes again once it was read
    std::size_t taken = 1;
    while (taken > 0 && sent < kTooMuch) {
      for (std::size_t i = 0; i < room.size(); ++i) room[i] = pattern(sent + i);
      taken = stream().write(room).value();
      ASSERT_LE(taken, room.size());
      sent += taken;
    }
    ASSERT_LT(sent, kTooMuch) << "a stream has finite room";
    ASSERT_TRUE(eventually([&] {
      EXPECT_EQ(0U, stream().read(spare).value());  // a driver goes on asking while it waits
      while (const std::size_t count = peer().read(room).value()) {
        for (std::size_t i = 0; i < count; ++i, ++got) {
          if (room[i] != pattern(got)) return true;
        }
      }
      return got >= sent;
    }));
    ASSERT_EQ(sent, got) << "the byte after these differs";
  }
}

TEST_P(DatagramContract, OneWriteIsOneDatagram) {
  connect();
  ASSERT_EQ(3U, stream().write(bytes_of("one")).value());
  ASSERT_EQ(5U, stream().write(bytes_of("three")).value());
  EXPECT_EQ("one", read_text(peer(), 1));
  EXPECT_EQ("three", read_text(peer(), 1));
}

TEST_P(ByteStreamContract, CloseIsFinalUntilTheNextOpen) {
  connect();
  stream().close();
  stream().close();
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  std::vector<std::byte> room(8);
  EXPECT_EQ(ErrorCode::invalid_state, stream().read(room).error().code);
  connect();
  ASSERT_EQ(5U, stream().write(bytes_of("again")).value());
  EXPECT_EQ("again", read_text(peer(), 5));
}

TEST_P(OrderedContract, PeerSeesTheClose) {
  connect();
  ByteStream& other = peer();
  ASSERT_EQ(3U, stream().write(bytes_of("bye")).value());
  stream().close();
  EXPECT_EQ("bye", read_text(other, 3));
  EXPECT_EQ(ErrorCode::disconnected, code_of_read(other));
}

TEST_P(ConnectionContract, LastWordsArriveBeforeTheLossIsReported) {
  connect();
  ASSERT_EQ(10U, peer().write(bytes_of("last words")).value());
  rig_->close_peer();
  EXPECT_EQ("last words", read_text(stream(), 10));
  EXPECT_EQ(ErrorCode::disconnected, code_of_read(stream()));
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  connect();
}

TEST_P(ConnectionContract, WritingToALostPeerDoesNotSwallowItsLastWords) {
  connect();
  ASSERT_EQ(10U, peer().write(bytes_of("last words")).value());
  rig_->close_peer();
  for (int i = 0; i < 20; ++i) {
    const auto written = stream().write(bytes_of("more"));
    ASSERT_TRUE(written.has_value()) << describe(written.error());
    std::this_thread::sleep_for(std::chrono::microseconds(200));  // lets a reset come back
  }
  EXPECT_EQ("last words", read_text(stream(), 10));
  EXPECT_EQ(ErrorCode::disconnected, code_of_read(stream()));
}

TEST_P(OrderedContract, WriteReportsTheLossWhenNothingIsLeftToRead) {
  connect();
  rig_->close_peer();
  Result<std::size_t> written = std::size_t{0};
  ASSERT_TRUE(eventually([&] {
    written = stream().write(bytes_of("anybody?"));
    return !written.has_value();
  }));
  EXPECT_EQ(ErrorCode::disconnected, written.error().code);
  EXPECT_EQ(StreamState::closed, stream().poll().value());
}

TEST_P(ConnectionContract, RefusalClosesTheStreamAndALaterTrySucceeds) {
  rig_->refuse_connects(true);
  ASSERT_TRUE(stream().open().has_value());
  EXPECT_EQ(ErrorCode::refused, code_of_connect());
  EXPECT_EQ(StreamState::closed, stream().poll().value());
  rig_->refuse_connects(false);
  connect();
}

}  // namespace forager::hal::contract
