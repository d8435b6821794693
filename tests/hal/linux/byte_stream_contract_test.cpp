#include "tests/hal/byte_stream_contract.hpp"

#include <optional>

#include "hal/linux/tcp_listener.hpp"
#include "hal/linux/tcp_stream.hpp"
#include "hal/linux/udp_peer.hpp"

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

const RigMaker kTcp{"Tcp", [] { return std::make_unique<TcpRig>(); }};
const RigMaker kUdp{"Udp", [] { return std::make_unique<UdpRig>(); }};

INSTANTIATE_TEST_SUITE_P(Sockets, ByteStreamContract, testing::Values(kTcp, kUdp), rig_name);
INSTANTIATE_TEST_SUITE_P(Sockets, ConnectionContract, testing::Values(kTcp), rig_name);
INSTANTIATE_TEST_SUITE_P(Sockets, DatagramContract, testing::Values(kUdp), rig_name);

}  // namespace
}  // namespace forager::hal::contract
