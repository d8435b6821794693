#include "hal/linux/service_notify.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace forager::hal {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::int64_t number(const std::string& text) {
  std::int64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() ? value : 0;
}

}  // namespace

ServiceNotify ServiceNotify::from_environment() {
  ServiceNotify service;
  const std::string path = variable("NOTIFY_SOCKET");
  if (path.size() < 2 || path.size() >= sizeof(sockaddr_un::sun_path) || (path[0] != '/' && path[0] != '@'))
    return service;
  service.fd_ = FileDescriptor(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!service.fd_.valid()) return service;
  service.socket_ = path;
  const std::string meant_for = variable("WATCHDOG_PID");
  if (meant_for.empty() || number(meant_for) == ::getpid())
    service.interval_ = std::chrono::microseconds(number(variable("WATCHDOG_USEC"))) / 2;
  return service;
}

void ServiceNotify::send(const char* text) const {
  if (socket_.empty()) return;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';  // a name of Linux's abstract namespace
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  static_cast<void>(::sendto(fd_.get(), text, std::strlen(text), MSG_NOSIGNAL | MSG_DONTWAIT,
                             reinterpret_cast<const sockaddr*>(&address), size));
}

void ServiceNotify::ready() { send("READY=1"); }

void ServiceNotify::stopping() { send("STOPPING=1"); }

void ServiceNotify::alive(Instant now) {
  if (!watched() || (last_ && now - *last_ < interval_)) return;
  last_ = now;
  send("WATCHDOG=1");
}

}  // namespace forager::hal
