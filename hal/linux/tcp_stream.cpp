#include "hal/linux/tcp_stream.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <cerrno>
#include <optional>
#include <utility>
#include <vector>

#include "hal/linux/connected_socket.hpp"
#include "hal/linux/socket_address.hpp"
#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

class TcpStream final : public ByteStream {
 public:
  TcpStream(std::string host, std::uint16_t port)
      : host_(std::move(host)), port_(port), name_(fmt::format("tcp {}:{}", host_, port_)) {}

 private:
  Result<> do_open() override {
    if (state_ != StreamState::closed)
      return fail(ErrorCode::invalid_state, name_, "open", "the stream is not closed");
    if (host_.empty() || port_ == 0)
      return fail(ErrorCode::invalid_argument, name_, "open", "a host and a port above 0 are needed");
    if (addresses_.empty()) {
      auto found = resolve(host_, port_, AddressUse::connect, name_);
      if (!found) return fail(std::move(found).error());
      addresses_ = *std::move(found);
    }
    next_ = 0;
    connect_next();
    if (failure_ && failure_->code == ErrorCode::permission) return take_failure();
    state_ = StreamState::opening;
    return {};
  }

  // Begins with the next address that the kernel takes; failure_ is set when none is left.
  void connect_next() {
    failure_.reset();
    while (next_ < addresses_.size()) {
      const SocketAddress& address = addresses_[next_++];
      if (begin_connect(address)) {
        failure_.reset();
        return;
      }
    }
    fd_.reset();
  }

  bool begin_connect(const SocketAddress& address) {
    auto fd = make_socket(address.family(), SOCK_STREAM, name_);
    if (!fd) {
      failure_ = std::move(fd).error();
      return false;
    }
    fd_ = *std::move(fd);
    const int on = 1;
    // A refusal of this option costs latency, not correctness.
    (void)::setsockopt(fd_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
    if (::connect(fd_.get(), address.get(), address.size) == 0 || errno == EINPROGRESS || errno == EINTR)
      return true;
    remember_failure(errno);
    return false;
  }

  void remember_failure(int error) { failure_ = socket_failure(name_, "connect", error).value(); }

  Failure take_failure() {
    Error error = failure_ ? *std::exchange(failure_, std::nullopt) : Error{};
    do_close();
    return fail(std::move(error));
  }

  Result<StreamState> do_poll() override {
    if (state_ != StreamState::opening) return state_;
    if (failure_) return take_failure();
    pollfd wait{fd_.get(), POLLOUT, 0};
    const int ready = ::poll(&wait, 1, 0);
    if (ready == 0 || (ready < 0 && errno == EINTR)) return state_;
    int error = 0;
    socklen_t size = sizeof(error);
    if (ready < 0 || ::getsockopt(fd_.get(), SOL_SOCKET, SO_ERROR, &error, &size) != 0) error = errno;
    if (error == 0 && is_connected_to_itself(fd_.get())) error = ECONNREFUSED;
    if (error == 0) return state_ = StreamState::open;
    remember_failure(error);
    if (next_ >= addresses_.size()) return take_failure();
    connect_next();
    return state_;
  }

  Result<std::size_t> do_read(std::span<std::byte> into) override {
    if (state_ != StreamState::open) return not_open("read");
    return closing_on_error(receive_stream(fd_.get(), into, name_));
  }

  Result<std::size_t> do_write(std::span<const std::byte> bytes) override {
    if (state_ != StreamState::open) return not_open("write");
    return closing_on_error(send_stream(fd_.get(), bytes, name_));
  }

  Result<std::size_t> closing_on_error(Result<std::size_t> result) {
    if (!result) do_close();
    return result;
  }

  Failure not_open(const char* operation) const {
    return fail(ErrorCode::invalid_state, name_, operation, "the stream is not open");
  }

  void do_close() override {
    fd_.reset();
    failure_.reset();
    state_ = StreamState::closed;
  }

  std::string_view do_name() const override { return name_; }

  std::string host_;
  std::uint16_t port_;
  std::string name_;
  std::vector<SocketAddress> addresses_;
  std::size_t next_ = 0;
  FileDescriptor fd_;
  StreamState state_ = StreamState::closed;
  std::optional<Error> failure_;
};

}  // namespace

std::unique_ptr<ByteStream> open_tcp_stream(std::string host, std::uint16_t port) {
  return std::make_unique<TcpStream>(std::move(host), port);
}

}  // namespace forager::hal
