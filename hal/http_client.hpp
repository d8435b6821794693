#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "hal/time.hpp"

namespace forager::hal {

enum class HttpMethod : std::uint8_t { get, put };

struct HttpRequest {
  HttpMethod method = HttpMethod::get;
  std::string path;          // absolute path, percent-encoded where needed: "/devices/x/readModes%5B0%5D"
  std::string body;          // for put; sent as it is
  std::string content_type;  // for put; empty means text/plain
  Duration timeout{};        // whole exchange, connect included; must be positive
};

struct HttpResponse {
  int status = 0;
  std::string body;
};

// One HTTP server, one request in flight (the AdvanReader serialises requests anyway). Never blocks. Answers
// a Digest challenge (RFC 7616: MD5, SHA-256, and -sess) when credentials were given at construction.
class HttpClient {
 public:
  virtual ~HttpClient() = default;

  // Sends a request. Errors: invalid_argument (path not absolute, timeout not positive), busy (one is in
  // flight), unsupported (built without libcurl), io.
  [[nodiscard]] Result<> start(const HttpRequest& request, Instant now) {
    if (request.path.empty() || request.path.front() != '/')
      return fail(ErrorCode::invalid_argument, std::string(name()), "start request",
                  "path '" + request.path + "' is not absolute");
    if (request.timeout <= Duration::zero())
      return fail(ErrorCode::invalid_argument, std::string(name()), "start request " + request.path,
                  "timeout is not positive");
    return do_start(request, now);
  }

  // nullopt while the answer is outstanding. Errors, each ending the request: timeout, refused (nobody
  // listens), not_present (the name does not resolve), disconnected, authentication (401 after the challenge
  // was answered, or without credentials to answer it), protocol, io, invalid_state (none in flight). Every
  // other HTTP status is a response, not an error.
  [[nodiscard]] Result<std::optional<HttpResponse>> poll(Instant now) { return do_poll(now); }

  // Gives up the request in flight, if any.
  void cancel() { do_cancel(); }

  [[nodiscard]] std::string_view name() const { return do_name(); }

 private:
  virtual Result<> do_start(const HttpRequest& request, Instant now) = 0;
  virtual Result<std::optional<HttpResponse>> do_poll(Instant now) = 0;
  virtual void do_cancel() = 0;
  virtual std::string_view do_name() const = 0;
};

}  // namespace forager::hal
