#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "hal/byte_stream.hpp"
#include "hal/linux/file_descriptor.hpp"

namespace forager::hal {

// Listens for TCP connections; what the emulated devices are served through. Stops listening when destroyed.
class TcpListener {
 public:
  // Binds and listens. host: an address of this machine; empty means every IPv4 address. port 0 lets the
  // kernel choose one, see port(). Errors: not_present (no such host or address here), busy (port in use),
  // permission (port below 1024), io.
  [[nodiscard]] static Result<TcpListener> listen(const std::string& host, std::uint16_t port);

  // The next waiting connection as an open stream, or null when nobody waits. Such a stream cannot be opened
  // again once closed (unsupported): the other side calls. Errors: io (out of descriptors); the listener
  // stays usable.
  [[nodiscard]] Result<std::unique_ptr<ByteStream>> accept();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string_view name() const { return name_; }  // "tcp listen 127.0.0.1:3177"

 private:
  TcpListener(FileDescriptor fd, std::uint16_t port, std::string name)
      : fd_(std::move(fd)), port_(port), name_(std::move(name)) {}

  FileDescriptor fd_;
  std::uint16_t port_;
  std::string name_;
};

}  // namespace forager::hal
