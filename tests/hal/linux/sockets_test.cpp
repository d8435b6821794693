#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <csignal>

#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"
#include "tests/hal/eventually.hpp"

namespace forager::hal {
namespace {

using contract::bytes_of;
using contract::eventually;
using contract::read_text;

// A name with an empty label fails in the resolver itself; no name server is asked.
TEST(TcpStream, NameThatDoesNotResolveIsNotPresentAndSaysWhatToDo) {
  auto stream = open_tcp_stream("no..such.host", 3177);
  const auto opened = stream->open();
  ASSERT_FALSE(opened.has_value());
  EXPECT_EQ(ErrorCode::not_present, opened.error().code);
  EXPECT_EQ("tcp no..such.host:3177", opened.error().device);
  EXPECT_NE(std::string::npos, opened.error().detail.find("no..such.host"));
  EXPECT_FALSE(opened.error().mend.empty());
  EXPECT_EQ(StreamState::closed, stream->poll().value());
}

TEST(TcpStream, PortZeroAndEmptyHostAreInvalid) {
  EXPECT_EQ(ErrorCode::invalid_argument, open_tcp_stream("127.0.0.1", 0)->open().error().code);
  EXPECT_EQ(ErrorCode::invalid_argument, open_tcp_stream("", 3177)->open().error().code);
}

TEST(TcpStream, TriesAllAddressesOfAName) {
  // localhost is 127.0.0.1 and, on most machines, ::1; the listener has only one of them.
  auto listener = TcpListener::listen("127.0.0.1", 0).value();
  auto stream = open_tcp_stream("localhost", listener.port());
  const auto opened = stream->open();
  if (!opened && opened.error().code == ErrorCode::not_present)
    GTEST_SKIP() << "this machine knows no name localhost (no /etc/hosts)";
  ASSERT_TRUE(opened.has_value()) << describe(opened.error());
  EXPECT_TRUE(eventually([&] { return stream->poll().value() == StreamState::open; }));
}

TEST(TcpStream, RefusalNamesTheDeviceAndTheMend) {
  std::uint16_t port = 0;
  { port = TcpListener::listen("127.0.0.1", 0).value().port(); }
  auto stream = open_tcp_stream("127.0.0.1", port);
  ASSERT_TRUE(stream->open().has_value());
  Result<StreamState> state = StreamState::opening;
  ASSERT_TRUE(eventually([&] {
    state = stream->poll();
    return !state.has_value();
  }));
  EXPECT_EQ(ErrorCode::refused, state.error().code);
  EXPECT_EQ(stream->name(), state.error().device);
  EXPECT_EQ("connect", state.error().operation);
  EXPECT_EQ(ECONNREFUSED, state.error().sys_errno);
  EXPECT_FALSE(state.error().mend.empty());
}

TEST(TcpListener, PortInUseIsBusy) {
  auto first = TcpListener::listen("127.0.0.1", 0).value();
  const auto second = TcpListener::listen("127.0.0.1", first.port());
  ASSERT_FALSE(second.has_value());
  EXPECT_EQ(ErrorCode::busy, second.error().code);
  EXPECT_NE(std::string::npos, second.error().device.find(std::to_string(first.port())));
}

TEST(TcpListener, AddressOfAnotherMachineIsNotPresent) {
  EXPECT_EQ(ErrorCode::not_present, TcpListener::listen("192.0.2.1", 0).error().code);
}

TEST(TcpListener, NobodyWaitingIsNoErrorAndAnAcceptedStreamCannotCallBack) {
  auto listener = TcpListener::listen("127.0.0.1", 0).value();
  EXPECT_EQ(nullptr, listener.accept().value());
  auto stream = open_tcp_stream("127.0.0.1", listener.port());
  ASSERT_TRUE(stream->open().has_value());
  std::unique_ptr<ByteStream> accepted;
  ASSERT_TRUE(eventually([&] { return (accepted = listener.accept().value()) != nullptr; }));
  EXPECT_EQ(StreamState::open, accepted->poll().value());
  EXPECT_EQ(ErrorCode::invalid_state, accepted->open().error().code);
  accepted->close();
  EXPECT_EQ(ErrorCode::unsupported, accepted->open().error().code);
}

// The port of a server whose client is still in TIME_WAIT must be usable again at once.
TEST(TcpListener, CanListenAgainOnTheSamePortAfterARestart) {
  std::uint16_t port = 0;
  {
    auto listener = TcpListener::listen("127.0.0.1", 0).value();
    port = listener.port();
    auto stream = open_tcp_stream("127.0.0.1", port);
    ASSERT_TRUE(stream->open().has_value());
    std::unique_ptr<ByteStream> accepted;
    ASSERT_TRUE(eventually([&] { return (accepted = listener.accept().value()) != nullptr; }));
    accepted->close();  // the server closes first and so keeps the port in TIME_WAIT
  }
  EXPECT_TRUE(TcpListener::listen("127.0.0.1", port).has_value());
}

TEST(Sockets, WritingToAClosedPeerRaisesNoSignal) {
  // The default action of SIGPIPE would end this program.
  auto previous = std::signal(SIGPIPE, SIG_DFL);
  auto listener = TcpListener::listen("127.0.0.1", 0).value();
  auto stream = open_tcp_stream("127.0.0.1", listener.port());
  ASSERT_TRUE(stream->open().has_value());
  std::unique_ptr<ByteStream> accepted;
  ASSERT_TRUE(eventually([&] {
    if (!accepted) accepted = listener.accept().value();
    return accepted && stream->poll().value() == StreamState::open;
  }));
  accepted->close();
  EXPECT_TRUE(eventually([&] { return !stream->write(bytes_of("x")).has_value(); }));
  std::signal(SIGPIPE, previous);
}

TEST(Sockets, AreNotInheritedByChildProcesses) {
  auto listener = TcpListener::listen("127.0.0.1", 0).value();
  auto stream = open_tcp_stream("127.0.0.1", listener.port());
  ASSERT_TRUE(stream->open().has_value());
  std::unique_ptr<ByteStream> accepted;
  ASSERT_TRUE(eventually([&] { return (accepted = listener.accept().value()) != nullptr; }));
  auto udp = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(udp->open().has_value());
  int sockets = 0;
  for (int fd = 3; fd < 256; ++fd) {
    int type = 0;
    socklen_t size = sizeof(type);
    if (::getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0) continue;
    ++sockets;
    EXPECT_NE(0, ::fcntl(fd, F_GETFD) & FD_CLOEXEC) << "descriptor " << fd;
    EXPECT_NE(0, ::fcntl(fd, F_GETFL) & O_NONBLOCK) << "descriptor " << fd;
  }
  EXPECT_GE(sockets, 4);
}

TEST(UdpPeer, AbsentPeerIsNoErrorAndMayComeLater) {
  std::uint16_t port = 0;
  {
    auto early = open_udp_listener("127.0.0.1", 0);
    ASSERT_TRUE(early->open().has_value());
    port = early->local_port();
  }
  auto peer = open_udp_peer("127.0.0.1", port);
  ASSERT_TRUE(peer->open().has_value());
  EXPECT_EQ(StreamState::open, peer->poll().value());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(4U, peer->write(bytes_of("lost")).value());
  std::vector<std::byte> room(16);
  EXPECT_EQ(0U, peer->read(room).value());

  auto late = open_udp_listener("127.0.0.1", port);
  ASSERT_TRUE(late->open().has_value());
  ASSERT_TRUE(peer->write(bytes_of("here")).has_value());
  ASSERT_TRUE(eventually([&] { return late->poll().value() == StreamState::open; }));
  EXPECT_EQ("here", read_text(*late, 4));
}

TEST(UdpPeer, ListenerIsOpeningUntilSomebodySpeaksAndThenHearsOnlyThem) {
  auto listener = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(listener->open().has_value());
  EXPECT_EQ(StreamState::opening, listener->poll().value());
  EXPECT_EQ(ErrorCode::invalid_state, listener->write(bytes_of("early")).error().code);

  auto first = open_udp_peer("127.0.0.1", listener->local_port());
  auto stranger = open_udp_peer("127.0.0.1", listener->local_port());
  ASSERT_TRUE(first->open().has_value());
  ASSERT_TRUE(stranger->open().has_value());
  ASSERT_TRUE(first->write(bytes_of("first")).has_value());
  ASSERT_TRUE(stranger->write(bytes_of("intruder")).has_value());  // queued before the peer is known
  ASSERT_TRUE(eventually([&] { return listener->poll().value() == StreamState::open; }));
  ASSERT_TRUE(first->write(bytes_of("second")).has_value());
  EXPECT_EQ("first", read_text(*listener, 1));
  EXPECT_EQ("second", read_text(*listener, 1));
  ASSERT_TRUE(listener->write(bytes_of("answer")).has_value());
  EXPECT_EQ("answer", read_text(*first, 1));
  std::vector<std::byte> room(64);
  EXPECT_EQ(0U, stranger->read(room).value());
}

TEST(UdpPeer, ListenerLearnsTheNextPeerWhenTheFirstHasGone) {
  auto listener = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(listener->open().has_value());
  const std::uint16_t port = listener->local_port();
  auto first = open_udp_peer("127.0.0.1", port);
  ASSERT_TRUE(first->open().has_value());
  ASSERT_TRUE(first->write(bytes_of("first")).has_value());
  ASSERT_TRUE(eventually([&] { return listener->poll().value() == StreamState::open; }));
  EXPECT_EQ("first", read_text(*listener, 1));
  first->close();

  ASSERT_TRUE(eventually([&] {
    if (listener->poll().value() == StreamState::opening) return true;
    (void)listener->write(bytes_of("anybody?"));  // comes back as "port closed"
    return false;
  }));
  EXPECT_EQ(port, listener->local_port());
  auto second = open_udp_peer("127.0.0.1", port);
  ASSERT_TRUE(second->open().has_value());
  ASSERT_TRUE(second->write(bytes_of("second")).has_value());
  ASSERT_TRUE(eventually([&] { return listener->poll().value() == StreamState::open; }));
  EXPECT_EQ("second", read_text(*listener, 1));
}

TEST(UdpPeer, ListenerThatIsOpenedAgainIsFoundAtTheSamePort) {
  auto listener = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(listener->open().has_value());
  const std::uint16_t port = listener->local_port();
  listener->close();
  ASSERT_TRUE(listener->open().has_value());
  EXPECT_EQ(port, listener->local_port());
}

TEST(UdpPeer, DropsWhatDoesNotFitTheRoomInsteadOfCuttingIt) {
  auto listener = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(listener->open().has_value());
  auto peer = open_udp_peer("127.0.0.1", listener->local_port());
  ASSERT_TRUE(peer->open().has_value());
  ASSERT_TRUE(peer->write(bytes_of(std::string(300, 'x'))).has_value());
  ASSERT_TRUE(peer->write(bytes_of("fits")).has_value());
  ASSERT_TRUE(eventually([&] { return listener->poll().value() == StreamState::open; }));
  std::vector<std::byte> room(279);
  Result<std::size_t> count = std::size_t{0};
  ASSERT_TRUE(eventually([&] { return (count = listener->read(room)).value() > 0; }));
  EXPECT_EQ("fits", contract::text_of(std::span(room).first(*count)));
}

TEST(UdpPeer, LocalPortInUseIsBusy) {
  auto first = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(first->open().has_value());
  auto second = open_udp_listener("127.0.0.1", first->local_port());
  EXPECT_EQ(ErrorCode::busy, second->open().error().code);
  EXPECT_EQ(0U, second->local_port());
}

TEST(UdpPeer, CanCallFromAGivenLocalPort) {
  auto listener = open_udp_listener("127.0.0.1", 0);
  ASSERT_TRUE(listener->open().has_value());
  auto scout = open_udp_listener("", 0);
  ASSERT_TRUE(scout->open().has_value());
  const std::uint16_t free_port = scout->local_port();
  scout->close();
  auto peer = open_udp_peer("127.0.0.1", listener->local_port(), free_port);
  ASSERT_TRUE(peer->open().has_value());
  EXPECT_EQ(free_port, peer->local_port());
}

}  // namespace
}  // namespace forager::hal
