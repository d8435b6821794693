#include "hal/linux/tcp_listener.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>

#include <array>
#include <cerrno>

#include "hal/linux/connected_socket.hpp"
#include "hal/linux/socket_address.hpp"
#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

class AcceptedStream final : public ByteStream {
 public:
  AcceptedStream(FileDescriptor fd, std::string name) : fd_(std::move(fd)), name_(std::move(name)) {}

 private:
  Result<> do_open() override {
    if (fd_.valid()) return fail(ErrorCode::invalid_state, name_, "open", "the stream is not closed");
    return fail(ErrorCode::unsupported, name_, "open", "an accepted connection cannot be called back");
  }
  Result<StreamState> do_poll() override { return fd_.valid() ? StreamState::open : StreamState::closed; }
  Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (!fd_.valid()) return fail(ErrorCode::invalid_state, name_, "read", "the stream is not open");
    return closing_on_error(receive_stream(fd_.get(), into, name_));
  }
  Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    if (!fd_.valid()) return fail(ErrorCode::invalid_state, name_, "write", "the stream is not open");
    return closing_on_error(send_stream(fd_.get(), bytes, name_));
  }
  Result<std::size_t> closing_on_error(Result<std::size_t> result) {
    if (!result) fd_.reset();
    return result;
  }
  void do_close() override { fd_.reset(); }
  std::string_view do_name() const override { return name_; }

  FileDescriptor fd_;
  std::string name_;
};

std::string text_of(const SocketAddress& address) {
  std::array<char, NI_MAXHOST> host{};
  if (::getnameinfo(address.get(), address.size, host.data(), host.size(), nullptr, 0, NI_NUMERICHOST) != 0)
    return "unknown";
  return fmt::format("{}:{}", host.data(), address.port());
}

Result<FileDescriptor> bind_and_listen(const SocketAddress& address, std::string_view name) {
  auto fd = make_socket(address.family(), SOCK_STREAM, name);
  if (!fd) return fd;
  const int on = 1;
  // Without it a restarted emulator would find its port "in use" for a minute.
  if (::setsockopt(fd->get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on)) != 0)
    return socket_failure(name, "set SO_REUSEADDR", errno);
  if (::bind(fd->get(), address.get(), address.size) != 0) return socket_failure(name, "bind", errno);
  if (::listen(fd->get(), 16) != 0) return socket_failure(name, "listen", errno);
  return fd;
}

// Failures of one arriving connection, not of the listener (accept(2)).
bool concerns_only_the_caller(int error) {
  switch (error) {
    case ECONNABORTED:
    case EPROTO:
    case ENETDOWN:
    case ENOPROTOOPT:
    case EHOSTDOWN:
    case ENONET:
    case EHOSTUNREACH:
    case EOPNOTSUPP:
    case ENETUNREACH:
      return true;
    default:
      return false;
  }
}

}  // namespace

Result<TcpListener> TcpListener::listen(const std::string& host, std::uint16_t port) {
  const std::string shown_host = host.empty() ? "0.0.0.0" : host;
  const std::string wanted = fmt::format("tcp listen {}:{}", shown_host, port);
  auto addresses = resolve(host, port, AddressUse::bind, wanted);
  if (!addresses) return fail(std::move(addresses).error());
  if (addresses->empty())
    return fail(ErrorCode::not_present, wanted, "look up host", "the name has no address");
  auto fd = bind_and_listen(addresses->front(), wanted);
  if (!fd) return fail(std::move(fd).error());
  const std::uint16_t bound = local_address_of(fd->get()).port();
  return TcpListener(*std::move(fd), bound, fmt::format("tcp listen {}:{}", shown_host, bound));
}

Result<std::unique_ptr<ByteStream>> TcpListener::accept() {
  for (;;) {
    SocketAddress peer;
    peer.size = sizeof(peer.storage);
    FileDescriptor fd(::accept4(fd_.get(), peer.get(), &peer.size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd.valid()) {
      const int error = errno;
      if (error == EINTR || concerns_only_the_caller(error)) continue;
      if (error == EAGAIN || error == EWOULDBLOCK) return std::unique_ptr<ByteStream>();
      return socket_failure(name_, "accept", error);
    }
    const int on = 1;
    // A refusal of this option costs latency, not correctness.
    (void)::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    return std::make_unique<AcceptedStream>(std::move(fd), fmt::format("tcp from {}", text_of(peer)));
  }
}

}  // namespace forager::hal
