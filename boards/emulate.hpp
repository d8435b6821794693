#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "boards/board.hpp"
#include "boards/scene.hpp"
#include "hal/error.hpp"
#include "hal/journal.hpp"
#include "hal/time.hpp"

namespace forager::boards {

struct NamedEndpoint {
  std::string name;  // "mavlink", "rest", "stream", "truth"
  Endpoint at;
};

// An emulated device served on real sockets. Port 0 in its options lets the kernel choose; endpoints() and
// address() tell which it was.
class EmulatedServer {
 public:
  virtual ~EmulatedServer() = default;
  virtual void update(hal::Instant now) = 0;
  // Where it listens.
  [[nodiscard]] virtual std::vector<NamedEndpoint> endpoints() const = 0;
  // The same as one line for a person.
  [[nodiscard]] virtual std::string address() const = 0;
  // How it stands now: one line for a person.
  [[nodiscard]] virtual std::string status() const = 0;
};

struct EmulatedAutopilotOptions {
  Endpoint listen{"127.0.0.1", 14550};  // MAVLink over UDP; learns its peer from the first datagram
  std::string serial;                   // not empty: a serial port of this name instead, made for it
  std::vector<Endpoint> truth;          // who is told where the vehicle really is
  std::uint64_t seed = 1;
  std::string refuse_arming;  // not empty: arming fails with this text
};

struct EmulatedReaderOptions {
  std::string host = "127.0.0.1";
  std::uint16_t rest_port = 3161;
  std::uint16_t stream_port = 3177;
  Endpoint truth{"127.0.0.1", 14572};  // where the autopilot's truth feed is received
  std::uint64_t seed = 1;
  std::string user;  // not empty: HTTP digest with these
  std::string password;
};

// Vehicle and flight controller of a scene. Errors: busy (address in use), permission, not_present.
[[nodiscard]] hal::Result<std::unique_ptr<EmulatedServer>> emulate_autopilot(
    const Scene& scene, const EmulatedAutopilotOptions& options, hal::Journal& journal);

// Reader, air and tags of a scene. Errors: as emulate_autopilot.
[[nodiscard]] hal::Result<std::unique_ptr<EmulatedServer>> emulate_reader(
    const Scene& scene, const EmulatedReaderOptions& options, hal::Journal& journal);

}  // namespace forager::boards
