#include "hal/linux/connected_socket.hpp"

#include <sys/socket.h>

#include <cerrno>

#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

bool has_unread_bytes(int fd) {
  std::byte probe{};
  return ::recv(fd, &probe, 1, MSG_DONTWAIT | MSG_PEEK) > 0;
}

}  // namespace

Result<std::size_t> receive_stream(int fd, std::span<std::byte> into, std::string_view device) {
  if (into.empty()) return std::size_t{0};  // recv() would answer 0 as for a closed peer
  for (;;) {
    const ssize_t got = ::recv(fd, into.data(), into.size(), MSG_DONTWAIT);
    if (got > 0) return static_cast<std::size_t>(got);
    if (got == 0)
      return fail(ErrorCode::disconnected, std::string(device), "read", "the peer closed the connection");
    if (errno == EINTR) continue;
    if (errno == EAGAIN || errno == EWOULDBLOCK) return std::size_t{0};
    // An established connection that times out was cut, whatever errno calls it.
    return socket_failure(device, "read", errno == ETIMEDOUT ? ECONNRESET : errno);
  }
}

Result<std::size_t> send_stream(int fd, std::span<const std::byte> bytes, std::string_view device) {
  if (bytes.empty()) return std::size_t{0};
  for (;;) {
    const ssize_t sent = ::send(fd, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0) return static_cast<std::size_t>(sent);
    const int error = errno;
    if (error == EINTR) continue;
    if (error == EAGAIN || error == EWOULDBLOCK) return std::size_t{0};
    if (has_unread_bytes(fd)) return std::size_t{0};
    return socket_failure(device, "write", error == ETIMEDOUT ? ECONNRESET : error);
  }
}

}  // namespace forager::hal
