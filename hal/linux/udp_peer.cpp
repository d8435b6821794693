#include "hal/linux/udp_peer.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <optional>
#include <utility>
#include <vector>

#include "hal/linux/socket_address.hpp"
#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

// Dropped datagrams skipped in one read(): bounds the time a flood of strangers can take.
constexpr int kMaxSkipped = 32;

enum class Role : std::uint8_t {
  caller,    // host and port are the peer's
  listener,  // host and port are ours; the peer is learnt
};

class UdpSocket final : public UdpPeer {
 public:
  UdpSocket(Role role, std::string host, std::uint16_t port, std::uint16_t local_port)
      : role_(role), host_(std::move(host)), port_(port), local_port_(local_port) {
    name_ = learns() ? fmt::format("udp listen {}:{}", host_.empty() ? "0.0.0.0" : host_, local_port)
                     : fmt::format("udp {}:{}", host_, port_);
  }
  std::uint16_t local_port() const override {
    return fd_.valid() ? local_address_of(fd_.get()).port() : std::uint16_t{0};
  }

 private:
  bool learns() const { return role_ == Role::listener; }

  Result<> do_open() override {
    if (fd_.valid()) return fail(ErrorCode::invalid_state, name_, "open", "the stream is not closed");
    if (!learns() && (host_.empty() || port_ == 0))
      return fail(ErrorCode::invalid_argument, name_, "open", "a host and a port above 0 are needed");
    if (addresses_.empty()) {
      auto found = resolve(host_, port_, learns() ? AddressUse::bind : AddressUse::connect, name_);
      if (!found) return fail(std::move(found).error());
      addresses_ = *std::move(found);
      if (addresses_.empty())
        return fail(ErrorCode::not_present, name_, "look up host", "the name has no address");
    }
    auto opened = learns() ? bind_to(addresses_.front()) : bind_and_connect(addresses_.front());
    if (!opened) do_close();
    // Whoever was told which port the kernel chose must find it again after close() and open().
    if (opened && learns()) addresses_.front() = local_address_of(fd_.get());
    return opened;
  }

  Result<> bind_to(const SocketAddress& address) {
    auto fd = make_socket(address.family(), SOCK_DGRAM, name_);
    if (!fd) return fail(std::move(fd).error());
    fd_ = *std::move(fd);
    if (::bind(fd_.get(), address.get(), address.size) != 0) return socket_failure(name_, "bind", errno);
    state_ = StreamState::opening;
    return {};
  }

  Result<> bind_and_connect(const SocketAddress& remote) {
    const std::string any = remote.family() == AF_INET ? "0.0.0.0" : "::";
    const auto local = resolve(any, local_port_, AddressUse::bind, name_);
    if (!local) return fail(local.error());
    FORAGER_TRY(bind_to(local->front()));
    return connect_to(remote);
  }

  // Makes the kernel filter foreign datagrams and report a closed port at the peer.
  Result<> connect_to(const SocketAddress& remote) {
    if (::connect(fd_.get(), remote.get(), remote.size) != 0) return socket_failure(name_, "connect", errno);
    peer_ = remote;
    state_ = StreamState::open;
    return {};
  }

  Result<StreamState> do_poll() override {
    if (state_ != StreamState::opening) return state_;
    SocketAddress sender;
    sender.size = sizeof(sender.storage);
    std::byte probe{};
    const ssize_t got = ::recvfrom(fd_.get(), &probe, 1, MSG_DONTWAIT | MSG_PEEK, sender.get(), &sender.size);
    if (got < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR || errno == ECONNREFUSED) return state_;
      return close_with(errno, "receive");
    }
    if (const auto connected = connect_to(sender); !connected) {
      do_close();
      return fail(connected.error());
    }
    return state_;
  }

  Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (state_ != StreamState::open)
      return fail(ErrorCode::invalid_state, name_, "read", "the stream is not open");
    if (into.empty()) return std::size_t{0};
    for (int skipped = 0; skipped < kMaxSkipped; ++skipped) {
      SocketAddress sender;
      sender.size = sizeof(sender.storage);
      const ssize_t got = ::recvfrom(fd_.get(), into.data(), into.size(), MSG_DONTWAIT | MSG_TRUNC,
                                     sender.get(), &sender.size);
      if (got < 0) {
        if (errno == EINTR) continue;
        if (errno == EAGAIN || errno == EWOULDBLOCK) return std::size_t{0};
        if (errno != ECONNREFUSED) return close_with(errno, "read");
        FORAGER_TRY(peer_closed_its_port());
        if (state_ != StreamState::open) return std::size_t{0};
        continue;
      }
      const auto size = static_cast<std::size_t>(got);
      // Datagrams that came between bind and connect were queued unfiltered.
      if (size > 0 && size <= into.size() && sender == peer_) return size;
    }
    return std::size_t{0};
  }

  Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    if (state_ != StreamState::open)
      return fail(ErrorCode::invalid_state, name_, "write", "the stream is not open");
    if (bytes.empty()) return std::size_t{0};
    // The first send after a report of a closed port carries that report instead of the datagram.
    for (int attempt = 0; attempt < 3; ++attempt) {
      const ssize_t sent = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      if (sent >= 0) return static_cast<std::size_t>(sent);
      if (errno == EAGAIN || errno == EWOULDBLOCK || errno == ENOBUFS) return std::size_t{0};
      if (errno == EINTR) continue;
      if (errno != ECONNREFUSED) return close_with(errno, "write");
      FORAGER_TRY(peer_closed_its_port());
      if (state_ != StreamState::open) return std::size_t{0};
    }
    return bytes.size();  // lost on the way, as UDP is
  }

  // A fixed peer may come back on the same port. A learnt one comes back on another: listen anew, on the same
  // local port. Rebinding is done with a fresh socket because dissolving a connected one may drop its port.
  Result<> peer_closed_its_port() {
    if (!learns()) return {};
    const SocketAddress bound_before = local_address_of(fd_.get());
    fd_.reset();
    auto bound = bind_to(bound_before);
    if (!bound) do_close();
    return bound;
  }

  Failure close_with(int error, const char* operation) {
    do_close();
    return socket_failure(name_, operation, error);
  }

  void do_close() override {
    fd_.reset();
    state_ = StreamState::closed;
  }

  std::string_view do_name() const override { return name_; }

  Role role_;
  std::string host_;
  std::uint16_t port_;
  std::uint16_t local_port_;
  std::string name_;
  std::vector<SocketAddress> addresses_;
  SocketAddress peer_;
  FileDescriptor fd_;
  StreamState state_ = StreamState::closed;
};

}  // namespace

std::unique_ptr<UdpPeer> open_udp_peer(std::string remote_host, std::uint16_t remote_port,
                                       std::uint16_t local_port) {
  return std::make_unique<UdpSocket>(Role::caller, std::move(remote_host), remote_port, local_port);
}

std::unique_ptr<UdpPeer> open_udp_listener(std::string local_host, std::uint16_t local_port) {
  return std::make_unique<UdpSocket>(Role::listener, std::move(local_host), local_port, local_port);
}

}  // namespace forager::hal
