#include "hal/linux/socket_address.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "hal/linux/socket_error.hpp"

namespace forager::hal {

namespace {

// The kernel's address structures overlay sockaddr_storage; copying keeps strict aliasing.
template <class T>
T view(const SocketAddress& address) {
  T out{};
  std::memcpy(&out, &address.storage, sizeof(out));
  return out;
}

}  // namespace

std::uint16_t SocketAddress::port() const {
  if (family() == AF_INET) return ntohs(view<sockaddr_in>(*this).sin_port);
  if (family() == AF_INET6) return ntohs(view<sockaddr_in6>(*this).sin6_port);
  return 0;
}

bool operator==(const SocketAddress& a, const SocketAddress& b) {
  if (a.family() != b.family() || a.port() != b.port()) return false;
  if (a.family() == AF_INET)
    return view<sockaddr_in>(a).sin_addr.s_addr == view<sockaddr_in>(b).sin_addr.s_addr;
  const auto a6 = view<sockaddr_in6>(a).sin6_addr;
  const auto b6 = view<sockaddr_in6>(b).sin6_addr;
  return std::memcmp(&a6, &b6, sizeof(a6)) == 0;
}

Result<std::vector<SocketAddress>> resolve(const std::string& host, std::uint16_t port, AddressUse use,
                                           std::string_view device) {
  const bool any = use == AddressUse::bind && host.empty();
  addrinfo hints{};
  hints.ai_family = any ? AF_INET : AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;  // one entry per address; the socket's real type does not matter here
  hints.ai_flags = AI_NUMERICSERV | (use == AddressUse::bind ? AI_PASSIVE : 0);

  addrinfo* list = nullptr;
  const std::string service = fmt::format("{}", port);
  const int status = ::getaddrinfo(any ? nullptr : host.c_str(), service.c_str(), &hints, &list);
  if (status == EAI_SYSTEM) return socket_failure(device, "look up host", errno);
  if (status == EAI_MEMORY) return socket_failure(device, "look up host", ENOMEM);
  if (status != 0)
    return fail(ErrorCode::not_present, std::string(device), "look up host",
                fmt::format("'{}' does not resolve ({})", host, ::gai_strerror(status)),
                "Check the spelling, or give the numeric address");

  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> guard(list, &::freeaddrinfo);
  std::vector<SocketAddress> found;
  for (const addrinfo* entry = list; entry != nullptr; entry = entry->ai_next) {
    if (entry->ai_addrlen > sizeof(sockaddr_storage)) continue;
    SocketAddress address;
    std::memcpy(&address.storage, entry->ai_addr, entry->ai_addrlen);
    address.size = entry->ai_addrlen;
    found.push_back(address);
  }
  std::stable_partition(found.begin(), found.end(),
                        [](const SocketAddress& address) { return address.family() == AF_INET; });
  return found;
}

Result<FileDescriptor> make_socket(int family, int type, std::string_view device) {
  FileDescriptor fd(::socket(family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!fd.valid()) return socket_failure(device, "make socket", errno);
  return fd;
}

SocketAddress local_address_of(int fd) {
  SocketAddress address;
  address.size = sizeof(address.storage);
  if (::getsockname(fd, address.get(), &address.size) != 0) return {};
  return address;
}

bool is_connected_to_itself(int fd) {
  SocketAddress peer;
  peer.size = sizeof(peer.storage);
  return ::getpeername(fd, peer.get(), &peer.size) == 0 && peer == local_address_of(fd);
}

}  // namespace forager::hal
