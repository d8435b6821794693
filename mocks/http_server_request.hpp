#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>

namespace forager::mocks {

// A request as it came: method and target untouched.
struct HttpServerRequest {
  std::string method;
  std::string target;         // origin form, "/devices?x", percent-encoding checked but kept
  std::string authorization;  // value of the header, empty if none
  std::string body;
  bool keep_alive = true;
};

struct HttpServerLimits {
  std::size_t header_bytes = 16 * 1024;  // request line and headers; more: 431
  std::size_t body_bytes = 1024 * 1024;  // more: 413
};

struct HttpNeedsMore {
  bool expects_continue = false;  // the client waits for "100 Continue" before it sends the body
};
struct HttpRejected {
  int status;  // 400, 411, 413, 431, 501 or 505; the connection cannot go on
};
using HttpParse = std::variant<HttpNeedsMore, HttpServerRequest, HttpRejected>;

// Takes the first request off the bytes received so far, or says why not (HTTP/1.0 and HTTP/1.1, RFC 9112;
// bodies by Content-Length only). On HttpNeedsMore and HttpRejected `bytes` stays as it is, but for blank
// lines in front.
[[nodiscard]] HttpParse take_http_request(std::string& bytes, const HttpServerLimits& limits);

[[nodiscard]] bool same_ignoring_case(std::string_view a, std::string_view b);

}  // namespace forager::mocks
