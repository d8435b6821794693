#include "tests/hal/byte_stream_contract.hpp"

#include <optional>

#include "hal/linux/pseudo_terminal.hpp"
#include "hal/linux/serial_port.hpp"
#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"
#include "mocks/virtual_clock.hpp"
#include "tests/scratch_folder.hpp"

namespace forager::hal::contract {
namespace {

class TcpRig final : public StreamRig {
 public:
  TcpRig() : stream_(open_tcp_stream("127.0.0.1", listener_->port())) {}

  ByteStream& stream() override { return *stream_; }
  ByteStream& peer() override { return *accepted_; }
  void serve() override {
    if (!listener_) return;
    if (auto next = listener_->accept().value()) accepted_ = std::move(next);
  }
  void close_peer() override { accepted_->close(); }
  void refuse_connects(bool refuse) override {
    const std::uint16_t port = port_;
    if (refuse)
      listener_.reset();
    else
      listener_.emplace(TcpListener::listen("127.0.0.1", port).value());
  }

 private:
  std::optional<TcpListener> listener_ = TcpListener::listen("127.0.0.1", 0).value();
  std::uint16_t port_ = listener_->port();
  std::unique_ptr<ByteStream> stream_;
  std::unique_ptr<ByteStream> accepted_;
};

class UdpRig final : public StreamRig {
 public:
  UdpRig() {
    EXPECT_TRUE(listener_->open().has_value());
    stream_ = open_udp_peer("127.0.0.1", listener_->local_port());
  }
  ByteStream& stream() override { return *stream_; }
  ByteStream& peer() override { return *listener_; }
  // A listener learns its peer from the first datagram, and a peer that was reopened has another port.
  void serve() override {
    if (stream_->poll().value() != StreamState::open || known_port_ == stream_->local_port()) return;
    known_port_ = stream_->local_port();
    const std::uint16_t port = listener_->local_port();
    listener_ = open_udp_listener("127.0.0.1", port);
    ASSERT_TRUE(listener_->open().has_value());
    ASSERT_TRUE(stream_->write(bytes_of("hello")).has_value());
    ASSERT_TRUE(eventually([&] { return listener_->poll().value() == StreamState::open; }));
    ASSERT_EQ("hello", read_text(*listener_, 5));
  }
  void close_peer() override { listener_->close(); }
  void refuse_connects(bool) override {}

 private:
  std::unique_ptr<UdpPeer> listener_ = open_udp_listener("127.0.0.1", 0);
  std::unique_ptr<UdpPeer> stream_;
  std::uint16_t known_port_ = 0;
};

// The adapter's name stays when it is unplugged and plugged in again.
class SerialRig final : public StreamRig {
 public:
  SerialRig() { serve(); }
  ByteStream& stream() override { return *stream_; }
  ByteStream& peer() override { return *far_; }
  void serve() override {
    if (!far_) far_ = open_pseudo_terminal(folder_.file("ttyUSB0")).value();
    if (far_->poll().value() == StreamState::closed) (void)far_->open();
  }
  void close_peer() override { far_.reset(); }
  void refuse_connects(bool) override {}

 private:
  test::ScratchFolder folder_;
  mocks::VirtualClock clock_;
  std::unique_ptr<PseudoTerminal> far_;
  std::unique_ptr<ByteStream> stream_ = open_serial_port({.device = folder_.file("ttyUSB0")}, clock_);
};

// The other way round: the emulated device's end of the line.
class TerminalRig final : public StreamRig {
 public:
  ByteStream& stream() override { return *far_; }
  ByteStream& peer() override { return *port_; }
  void serve() override {
    if (port_->poll().value() == StreamState::closed) (void)port_->open();
  }
  void close_peer() override { port_->close(); }
  void refuse_connects(bool) override {}

 private:
  mocks::VirtualClock clock_;
  std::unique_ptr<PseudoTerminal> far_ = open_pseudo_terminal().value();
  std::unique_ptr<ByteStream> port_ = open_serial_port({.device = far_->port()}, clock_);
};

const RigMaker kSerial{"Serial", [] { return std::make_unique<SerialRig>(); }};
const RigMaker kTerminal{"Terminal", [] { return std::make_unique<TerminalRig>(); }};
const RigMaker kTcp{"Tcp", [] { return std::make_unique<TcpRig>(); }};
const RigMaker kUdp{"Udp", [] { return std::make_unique<UdpRig>(); }};

INSTANTIATE_TEST_SUITE_P(Sockets, ByteStreamContract, testing::Values(kTcp, kUdp), rig_name);
INSTANTIATE_TEST_SUITE_P(Sockets, OrderedContract, testing::Values(kTcp), rig_name);
INSTANTIATE_TEST_SUITE_P(Sockets, ConnectionContract, testing::Values(kTcp), rig_name);
INSTANTIATE_TEST_SUITE_P(Sockets, DatagramContract, testing::Values(kUdp), rig_name);
INSTANTIATE_TEST_SUITE_P(Lines, ByteStreamContract, testing::Values(kSerial, kTerminal), rig_name);
INSTANTIATE_TEST_SUITE_P(Lines, OrderedContract, testing::Values(kSerial), rig_name);

}  // namespace
}  // namespace forager::hal::contract
