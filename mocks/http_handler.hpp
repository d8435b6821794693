#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/http_client.hpp"
#include "hal/time.hpp"

namespace forager::mocks {

struct HttpReply {
  int status = 200;
  std::string body;
};

// How the network sees a device: a booting one refuses connections, one without power says nothing at all.
enum class HttpReach : std::uint8_t { listening, refusing, silent };

// What answers requests behind an emulated HTTP server. Answers may take time and come in the order of the
// requests: one server, one thing at a time.
class HttpHandler {
 public:
  virtual ~HttpHandler() = default;
  // Takes a request in. `path` as it stood on the wire, percent-encoding included. The result names it.
  [[nodiscard]] virtual std::uint32_t submit(hal::HttpMethod method, std::string_view path,
                                             std::string_view body, hal::Instant now) = 0;
  // The answer, once; nullopt until it is there.
  [[nodiscard]] virtual std::optional<HttpReply> take(std::uint32_t request, hal::Instant now) = 0;
  // The client has gone: whatever the request does is done, but nobody will take its answer.
  virtual void forget(std::uint32_t request) = 0;
  // False once the answer was taken, or when the device lost the request (reboot, power cut).
  [[nodiscard]] virtual bool knows(std::uint32_t request) const = 0;
  [[nodiscard]] virtual HttpReach reach(hal::Instant now) = 0;
};

}  // namespace forager::mocks
