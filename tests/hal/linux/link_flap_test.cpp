// Real sockets and terminals that come and go: every descriptor is given back.
#include <gtest/gtest.h>

#include <optional>

#include "hal/linux/kernel.hpp"
#include "hal/linux/pseudo_terminal.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/hal/eventually.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::hal {
namespace {

using contract::bytes_of;
using contract::eventually;
using contract::read_text;

constexpr int kRounds = 200;

std::size_t open_descriptors() { return real_kernel().list("/proc/self/fd").size(); }

bool becomes_open(ByteStream& stream) {
  if (stream.poll().value_or(StreamState::closed) == StreamState::closed && !stream.open()) return false;
  return eventually([&] { return stream.poll().value_or(StreamState::closed) == StreamState::open; });
}

// Reads and writes until the stream says that the other end has gone.
bool notices_the_loss(ByteStream& stream) {
  std::vector<std::byte> room(16);
  return eventually([&] { return !stream.read(room) || !stream.write(bytes_of("still there?")); });
}

TEST(LinkFlap, TcpGivesBackItsDescriptors) {
  std::optional<TcpListener> listener = TcpListener::listen("127.0.0.1", 0).value();
  const std::uint16_t port = listener->port();
  const auto stream = open_tcp_stream("127.0.0.1", port);
  const std::size_t before = open_descriptors();
  for (int round = 0; round < kRounds; ++round) {
    ASSERT_TRUE(stream->open());
    std::unique_ptr<ByteStream> accepted;
    ASSERT_TRUE(eventually([&] {
      if (!accepted) accepted = listener->accept().value();
      return accepted && stream->poll().value_or(StreamState::closed) == StreamState::open;
    }));
    accepted.reset();
    ASSERT_TRUE(notices_the_loss(*stream));
    EXPECT_EQ(StreamState::closed, stream->poll().value());
    if (round % 10 != 0) continue;
    listener.reset();  // nobody listens for a while
    ASSERT_TRUE(stream->open());
    EXPECT_TRUE(eventually([&] { return !stream->poll().has_value(); }));
    listener.emplace(TcpListener::listen("127.0.0.1", port).value());
  }
  EXPECT_EQ(before, open_descriptors());
}

TEST(LinkFlap, ASerialPortGivesBackItsDescriptors) {
  const test::ScratchFolder folder;
  const mocks::VirtualClock clock;
  const auto port = open_serial_port({.device = folder.file("ttyUSB0")}, clock);
  const std::size_t before = open_descriptors();
  for (int round = 0; round < kRounds; ++round) {
    EXPECT_EQ(ErrorCode::not_present, port->open().error().code);
    auto adapter = open_pseudo_terminal(folder.file("ttyUSB0")).value();
    ASSERT_TRUE(adapter->open());
    ASSERT_TRUE(becomes_open(*port));
    ASSERT_TRUE(becomes_open(*adapter));
    ASSERT_EQ(2U, port->write(bytes_of("hi")).value());
    EXPECT_EQ("hi", read_text(*adapter, 2));
    adapter.reset();
    ASSERT_TRUE(notices_the_loss(*port));
  }
  EXPECT_EQ(before, open_descriptors());
}

TEST(LinkFlap, UdpGivesBackItsDescriptors) {
  const auto listener = open_udp_listener("127.0.0.1", 0);
  const std::size_t before = open_descriptors();
  for (int round = 0; round < kRounds; ++round) {
    ASSERT_TRUE(listener->open());
    const auto peer = open_udp_peer("127.0.0.1", listener->local_port());
    ASSERT_TRUE(becomes_open(*peer));
    ASSERT_TRUE(peer->write(bytes_of("hello")));
    ASSERT_TRUE(becomes_open(*listener));
    EXPECT_EQ("hello", read_text(*listener, 5));
    listener->close();
  }
  EXPECT_EQ(before, open_descriptors());
}

}  // namespace
}  // namespace forager::hal
