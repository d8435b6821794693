#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/linux/file_descriptor.hpp"
#include "hal/time.hpp"

namespace forager::hal {

// Tells systemd that a service is ready, lives and ends (sd_notify(3): datagrams of text to the socket that
// NOTIFY_SOCKET names), without its library. Where the variable is not set, that is outside of a service,
// nothing is sent. Nothing here fails: whoever supervises finds out by silence.
class ServiceNotify {
 public:
  // From NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID.
  [[nodiscard]] static ServiceNotify from_environment();

  void ready();
  // "WATCHDOG=1", at most as often as half the watchdog's time; to be called at every turn of the loop.
  void alive(Instant now);
  void stopping();
  [[nodiscard]] bool watched() const { return interval_ > Duration::zero(); }

 private:
  void send(const char* text) const;

  std::string socket_;  // empty: no service
  FileDescriptor fd_;
  Duration interval_{};  // zero: no watchdog
  std::optional<Instant> last_;
};

}  // namespace forager::hal
