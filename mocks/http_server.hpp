#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/byte_stream.hpp"
#include "hal/time.hpp"
#include "mocks/http_handler.hpp"
#include "mocks/http_server_digest.hpp"
#include "mocks/http_server_session.hpp"
#include "mocks/memory_stream.hpp"

namespace forager::mocks {

struct HttpServerConfig {
  bool digest = false;  // demand RFC 7616 Digest with these; Basic is answered with 401
  std::string realm = "AdvanNet";
  std::string user = "admin";
  std::string password = "admin";
  std::uint64_t seed = 1;                                 // of the nonces
  hal::Duration idle_timeout = std::chrono::seconds(60);  // without a byte from the client
  std::size_t max_connections = 16;                       // more are closed
  HttpServerLimits limits;
};

// The HTTP server of an emulated reader over any byte streams: lines in memory in tests, accepted sockets
// when it is served to the world. See HttpServerSession for the protocol.
class HttpServer {
 public:
  HttpServer(HttpServerConfig config, HttpHandler& handler);

  // A line whose device side becomes a connection whenever somebody dials. Must outlive its attachment.
  void attach(MemoryStreamPair& line);
  // The accepted side of a real connection; let go as soon as it is closed and cannot be opened again.
  void attach(hal::ByteStream& end);
  void detach(const hal::ByteStream& end);
  [[nodiscard]] bool attached(const hal::ByteStream& end) const;

  void update(hal::Instant now);
  [[nodiscard]] std::size_t connections() const;

 private:
  struct Line {
    hal::ByteStream* end = nullptr;
    MemoryStreamPair* pair = nullptr;
    std::uint32_t connection = 0;
    hal::Instant last_heard;
    bool lost = false;  // the device lost its power with this connection open
    std::unique_ptr<HttpServerSession> session;
  };
  bool service(Line& line, hal::Instant now);  // false: let the line go
  bool exchange(Line& line, hal::Instant now);
  static bool hang_up(Line& line);

  HttpServerConfig config_;
  HttpHandler* handler_;
  std::optional<HttpServerDigest> digest_;
  std::vector<std::unique_ptr<Line>> lines_;
};

}  // namespace forager::mocks
