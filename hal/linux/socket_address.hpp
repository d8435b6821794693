#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "hal/linux/file_descriptor.hpp"

namespace forager::hal {

// An IPv4 or IPv6 address with a port, as the kernel takes it.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  [[nodiscard]] sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  [[nodiscard]] int family() const { return storage.ss_family; }
  [[nodiscard]] std::uint16_t port() const;
  // Same family, address and port.
  friend bool operator==(const SocketAddress& a, const SocketAddress& b);
};

enum class AddressUse : std::uint8_t {
  connect,  // where a peer is
  bind,     // where we are; an empty host means every IPv4 address of this machine
};

// All addresses of a host, IPv4 first (field devices speak IPv4; a name such as localhost has both). A
// numeric address returns at once; a name asks the system's resolver, which may block for its own time-outs.
// Errors: not_present (the name does not resolve), io.
[[nodiscard]] Result<std::vector<SocketAddress>> resolve(const std::string& host, std::uint16_t port,
                                                         AddressUse use, std::string_view device);

// Non-blocking, close-on-exec socket. type: SOCK_STREAM or SOCK_DGRAM. Errors: io (out of descriptors),
// unsupported (no such address family in this kernel), permission.
[[nodiscard]] Result<FileDescriptor> make_socket(int family, int type, std::string_view device);

// Where a bound socket is; port 0 if it is not bound.
[[nodiscard]] SocketAddress local_address_of(int fd);

// TCP lets a socket that calls a port of its own machine where nobody listens meet itself, when the kernel
// happens to give it that very port.
[[nodiscard]] bool is_connected_to_itself(int fd);

}  // namespace forager::hal
